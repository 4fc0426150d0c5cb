#include "constraint/normals.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "base/error.hpp"
#include "constraint/supports.hpp"
#include "mesh/shape_functions.hpp"

namespace mortise::constraint {

namespace {

constexpr double smooth = 0.906;       // cosine of the angle up to which neighbouring faces are one smooth surface
constexpr double aligned = 1 - 1e-12;  // largest component of a normal that counts as parallel to its axis
constexpr double independent = 1e-3;   // length of what a direction has besides those that are prescribed already
constexpr double disagreement = 1e-9;  // relative, of prescribed displacements
// Of a displacement along a direction that is orthogonal to another but for its rounding.
constexpr double rounding_of_direction = 1e-14;

Point vector(const std::array<double, 3>& v)
{
  return {v[0], v[1], v[2]};
}
std::array<double, 3> array(const Point& v)
{
  return {v[0], v[1], v[2]};
}

// The unit normal of a face at its node k and its weight in the normal there, such that nodes on a circle or a sphere get the
// normal of that [Max, J. Graphics Tools 4 (1999)]; faces of second order know it better themselves.
Point weighted_normal(const mesh::Surface& surface, std::size_t face, std::size_t k)
{
  const auto nodes = surface.faces[face];
  const auto type = surface.faces.type[face];
  const auto at = [&](std::size_t n) -> const Point& {
    return surface.points[static_cast<std::size_t>(nodes[n % nodes.size()])];
  };
  if (type == mesh::CellType::line2) {
    const Point along = at(1) - at(0);
    return Point(along[1], -along[0], 0) / along.squaredNorm();
  }
  if (type == mesh::first_order(type)) {
    const Point next = at(k + 1) - at(k), last = at(k + nodes.size() - 1) - at(k);
    return next.cross(last) / (next.squaredNorm() * last.squaredNorm());
  }
  const auto& functions = mesh::shape_functions(type);
  Eigen::VectorXd value(functions.count());
  Eigen::MatrixXd gradient(functions.count(), mesh::dimension(type));
  functions.evaluate(functions.nodes()[k], value, &gradient);
  Eigen::Matrix<double, 3, 2> tangents = Eigen::Matrix<double, 3, 2>::Zero();
  for (std::size_t n = 0; n < nodes.size(); ++n)
    tangents.leftCols(gradient.cols()) += at(n) * gradient.row(static_cast<Eigen::Index>(n));
  if (gradient.cols() == 1) return Point(tangents(1, 0), -tangents(0, 0), 0).normalized();
  return Point(tangents.col(0)).cross(Point(tangents.col(1))).normalized();
}

// Joins normals that differ little, to one mean each.
std::vector<Point> clusters(std::span<const Point> weighted)
{
  std::vector<std::size_t> group(weighted.size());
  std::iota(group.begin(), group.end(), 0U);
  for (std::size_t a = 0; a < weighted.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      if (weighted[a].normalized().dot(weighted[b].normalized()) > smooth)
        std::replace(group.begin(), group.end(), group[a], group[b]);
  std::vector<Point> means;
  for (std::size_t g = 0; g < group.size(); ++g) {
    Point sum = Point::Zero();
    for (std::size_t a = 0; a < group.size(); ++a)
      if (group[a] == g) sum += weighted[a];
    if (sum.squaredNorm() > 0) means.push_back(sum.normalized());
  }
  return means;
}

[[noreturn]] void disagree(std::span<const Support> supports, int one, int other)
{
  const auto a = static_cast<std::size_t>(one), b = static_cast<std::size_t>(other);
  throw Error(ExitStatus::bad_input,
              fmt::format("supports[{}] (boundary \"{}\") and supports[{}] (boundary \"{}\") meet in a node and prescribe "
                          "different displacements along the same direction there; make them agree or drop one of them",
                          one, supports[a].boundary, other, supports[b].boundary));
}

// The directions that are prescribed at one node, orthonormal.
class Directions {
 public:
  Directions(std::span<const Support> supports, std::span<const PrescribedDof> components) : supports_(supports)
  {
    for (const auto& h : components)
      directions_.push_back(
          {h.node, array(Point::Unit(h.component)), h.value, {{{h.support, array(Point::Unit(h.component))}}}, 1});
    components_ = directions_.size();
  }

  void add(const NodeDirection& normal)
  {
    const double value = normal.value;
    SkewSupport next{normal.node, {}, value, {{{normal.support, normal.direction}}}, 1, normal.at};
    Point rest = vector(normal.direction);
    double size = std::abs(value), rounding = 0;
    for (const auto& known : directions_) {
      const double part = vector(known.direction).dot(vector(normal.direction));
      rounding += rounding_of_direction * std::abs(known.value);
      if (part == 0) continue;
      rest -= part * vector(known.direction);
      next.value -= part * known.value;
      size += std::abs(part * known.value);
      for (const auto& share : std::span(known.shares).first(static_cast<std::size_t>(known.share_count)))
        next.add_share(share.support, -part * vector(share.part));
    }
    const double length = rest.norm();
    if (length < independent) {
      if (std::abs(next.value) > disagreement * size + rounding)
        disagree(supports_, directions_.back().shares[0].support, normal.support);
      return;
    }
    next.value /= length;
    next.direction = array(rest / length);
    for (auto& share : next.shares) share.part = array(vector(share.part) / length);
    directions_.push_back(next);
  }

  std::span<const SkewSupport> skew_supports() const { return std::span(directions_).subspan(components_); }

 private:
  std::span<const Support> supports_;
  std::vector<SkewSupport> directions_;
  std::size_t components_ = 0;
};

}  // namespace

std::vector<NodeDirection> node_normals(std::span<const Support> supports, std::span<const mesh::Surface> surfaces,
                                        const Communicator& comm)
{
  struct Sent {
    Global node, face;
    int support;
    double weighted[3];
    double value, at[3];
  };
  std::vector<std::vector<Sent>> send(static_cast<std::size_t>(comm.size()));
  collectively(comm, [&] {
    for (std::size_t i = 0; i < supports.size(); ++i) {
      if (!supports[i].normal) continue;
      const auto& surface = surfaces[i];
      for (std::size_t f = 0; f < surface.faces.size(); ++f)
        for (std::size_t k = 0; k < surface.faces[f].size(); ++k) {
          const auto at = static_cast<std::size_t>(surface.faces[f][k]);
          const Global node = surface.node_id[at];
          const Point n = weighted_normal(surface, f, k);
          const Point& x = surface.points[at];
          const double value = value_at(supports, static_cast<int>(i), *supports[i].normal, x);
          send[static_cast<std::size_t>(node % comm.size())].push_back(
              {node, surface.face_id[f], static_cast<int>(i), {n[0], n[1], n[2]}, value, {x[0], x[1], x[2]}});
        }
    }
  });
  std::vector<Sent> all;
  for (const auto& part : comm.exchange(send)) all.insert(all.end(), part.begin(), part.end());
  std::sort(all.begin(), all.end(), [](const Sent& a, const Sent& b) {
    return std::tie(a.node, a.support, a.face) < std::tie(b.node, b.support, b.face);
  });
  std::vector<NodeDirection> normals;
  for (auto begin = all.begin(); begin != all.end();) {
    const auto end =
        std::find_if(begin, all.end(), [&](const Sent& s) { return s.node != begin->node || s.support != begin->support; });
    std::vector<Point> weighted;
    for (auto s = begin; s != end; ++s) weighted.emplace_back(s->weighted[0], s->weighted[1], s->weighted[2]);
    for (const auto& mean : clusters(weighted))
      normals.push_back({begin->node, begin->support, array(mean), begin->value, {begin->at[0], begin->at[1], begin->at[2]}});
    begin = end;
  }
  return normals;
}

std::vector<NodeDirection> axes_directions(std::span<const Support> supports, std::span<const SupportNodes> nodes, int dimension,
                                           double rounding, const Communicator& comm)
{
  std::vector<std::vector<NodeDirection>> send(static_cast<std::size_t>(comm.size()));
  collectively(comm, [&] {
    for (std::size_t i = 0; i < supports.size(); ++i) {
      if (!supports[i].axes) continue;
      const auto& displacement = supports[i].displacement;
      for (std::size_t n = 0; n < nodes[i].id.size(); ++n) {
        const Global node = nodes[i].id[n];
        const Point& place = nodes[i].at[n];
        auto& to = send[static_cast<std::size_t>(node % comm.size())];
        const auto axes = supports[i].axes->at(place, rounding);
        const auto value = [&](std::size_t c) { return value_at(supports, static_cast<int>(i), *displacement[c], place); };
        for (std::size_t c = 0; axes && c < static_cast<std::size_t>(dimension); ++c)
          if (displacement[c])
            to.push_back(
                {node, static_cast<int>(i), array(axes->row(static_cast<Eigen::Index>(c)).transpose()), value(c), array(place)});
        if (axes) continue;
        const Point axis = supports[i].axes->axis();
        if (displacement[2] && dimension == 3) to.push_back({node, static_cast<int>(i), array(axis), value(2), array(place)});
        if (!displacement[0]) continue;
        if (value(0) != 0)
          throw Error(ExitStatus::bad_input,
                      fmt::format("supports[{}] (boundary \"{}\") prescribes a radial displacement of {:.6g} at ({:.6g}, {:.6g}, "
                                  "{:.6g}), which lies on the axis and has no radial direction",
                                  i, supports[i].boundary, value(0), place[0], place[1], place[2]));
        const Point across = axis.unitOrthogonal(), other = axis.cross(across);
        to.push_back({node, static_cast<int>(i), array(across), 0, array(place)});
        to.push_back({node, static_cast<int>(i), array(other), 0, array(place)});
      }
    }
  });
  std::vector<NodeDirection> all;
  for (const auto& part : comm.exchange(send)) all.insert(all.end(), part.begin(), part.end());
  const auto key = [](const NodeDirection& d) { return std::tie(d.node, d.support, d.direction); };
  std::sort(all.begin(), all.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
  all.erase(std::unique(all.begin(), all.end(), [&](const auto& a, const auto& b) { return key(a) == key(b); }), all.end());
  return all;
}

std::vector<PrescribedDof> take_axis_aligned(std::vector<NodeDirection>& directions)
{
  std::vector<PrescribedDof> prescribed;
  std::erase_if(directions, [&](const NodeDirection& normal) {
    for (int c = 0; c < 3; ++c) {
      const double along = normal.direction[static_cast<std::size_t>(c)];
      if (std::abs(along) < aligned) continue;
      prescribed.push_back({normal.node, c, along > 0 ? normal.value : -normal.value, normal.support, normal.at});
      return true;
    }
    return false;
  });
  return prescribed;
}

std::vector<SkewSupport> skew_support_rows(std::span<const Support> supports, std::span<const NodeDirection> directions,
                                           std::span<const PrescribedDof> prescribed, const Communicator& comm)
{
  std::vector<SkewSupport> result;
  collectively(comm, [&] {
    for (auto begin = directions.begin(); begin != directions.end();) {
      const auto end = std::find_if(begin, directions.end(), [&](const NodeDirection& d) { return d.node != begin->node; });
      const auto first = std::lower_bound(prescribed.begin(), prescribed.end(), begin->node,
                                          [](const PrescribedDof& h, Global node) { return h.node < node; });
      const auto last = std::find_if(first, prescribed.end(), [&](const PrescribedDof& h) { return h.node != begin->node; });
      if (const auto free = std::find_if(first, last, [](const PrescribedDof& h) { return h.unknown; }); free != last)
        throw_prescribed_coupling(supports, free->support, begin->support);
      Directions here(supports, {first, last});
      for (auto direction = begin; direction != end; ++direction) here.add(*direction);
      for (SkewSupport row : here.skew_supports()) {
        const auto shares = std::span(row.shares).first(static_cast<std::size_t>(row.share_count));
        row.along_normals = std::all_of(shares.begin(), shares.end(), [&](const SkewSupport::Share& share) {
          return supports[static_cast<std::size_t>(share.support)].normal.has_value();
        });
        result.push_back(row);
      }
      begin = end;
    }
  });
  return result;
}

}  // namespace mortise::constraint
