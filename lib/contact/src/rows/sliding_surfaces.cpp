#include "contact/sliding_surfaces.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>

#include "base/dense.hpp"
#include "fem/element.hpp"
#include "mesh/shape_functions.hpp"
#include "rows/by_node.hpp"

namespace mortise::contact {

namespace {

using constraint::SlidingSurface;
constexpr double edge_cosine = 0.77;  // cosine of the angle from which two faces at a node are an edge, as in patches.cpp

struct Key {
  int contact, side, body;  // side 1 is the secondary one
  auto operator<=>(const Key&) const = default;
};

// A face of this rank that counts.
struct TouchedFace {
  Key key;
  const mesh::Surface* surface;
  std::size_t face;
};

struct At {
  Point x = Point::Zero(), normal = Point::Zero();  // outward, as long as the weight
};

Point normal_of(const Eigen::MatrixXd& gradient, const mesh::Surface& surface, std::size_t face, bool solid)
{
  Eigen::Matrix<double, 3, 2> tangents = Eigen::Matrix<double, 3, 2>::Zero();  // in 2D the first alone
  const auto nodes = surface.faces[face];
  for (std::size_t i = 0; i < nodes.size(); ++i)
    tangents.leftCols(gradient.cols()) +=
        surface.points[static_cast<std::size_t>(nodes[i])] * gradient.row(static_cast<Eigen::Index>(i));
  if (solid) return Point(tangents.col(0)).cross(Point(tangents.col(1)));
  return {tangents(1, 0), -tangents(0, 0), 0};
}

At at_point(const TouchedFace& face, fem::Kinematics kinematics, const Eigen::VectorXd& shape, const Eigen::MatrixXd& gradient,
            double weight)
{
  const auto& surface = *face.surface;
  const auto nodes = surface.faces[face.face];
  At at;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    at.x += shape[static_cast<Eigen::Index>(i)] * surface.points[static_cast<std::size_t>(nodes[i])];
  at.normal = weight * fem::thickness(kinematics, at.x[0]) *
              normal_of(gradient, surface, face.face, kinematics == fem::Kinematics::solid);
  return at;
}

// Exact for squares of linear fields: the one point of a triangle's stiffness sees nothing of what turns about it.
std::vector<At> quadrature(const TouchedFace& face, fem::Kinematics kinematics)
{
  const auto type = face.surface->faces.type[face.face];
  const fem::Element& element = fem::element(type);
  std::vector<At> result;
  if (type == mesh::CellType::tri3) {
    for (int corner = 0; corner < 3; ++corner) {
      Eigen::VectorXd shape = Eigen::VectorXd::Constant(3, 1.0 / 6);
      shape[corner] = 2.0 / 3;
      result.push_back(at_point(face, kinematics, shape, element.gradient[0], element.weight[0] / 3));
    }
    return result;
  }
  for (std::size_t q = 0; q < element.points(); ++q)
    result.push_back(at_point(face, kinematics, element.shape[q], element.gradient[q], element.weight[q]));
  return result;
}

// A node in rows of a contact, with the sum of their normals, out of its own body.
struct Touch {
  Global node;
  int contact, side;
  double x, y, z;
  Point normal() const { return {x, y, z}; }
};

std::vector<Touch> touches(const constraint::Contacts& contacts)
{
  std::map<std::tuple<Global, int, int>, Point> sums;
  for (const auto& node : contacts.nodes) {
    Global before = -1;
    for (const auto& entry : contacts.rows[node.row]) {
      const double sign = entry.coefficient * node.normal[entry.component];
      if (entry.node == before || sign == 0) continue;
      before = entry.node;
      const auto place = sums.emplace(std::tuple(entry.node, node.contact, sign > 0 ? 1 : 0), Point::Zero()).first;
      place->second += sign > 0 ? node.normal : Point(-node.normal);
    }
    sums.emplace(std::tuple(node.node, node.contact, 1), node.normal);  // one whose entries supports hold
  }
  std::vector<Touch> result;
  for (const auto& [key, n] : sums) result.push_back({std::get<0>(key), std::get<1>(key), std::get<2>(key), n[0], n[1], n[2]});
  return result;
}

// The faces that have a node in a row of their contact and look where it pushes: not the end of a pin whose skin is in a hole.
std::vector<TouchedFace> touched(std::span<const Pair> pairs, const constraint::Contacts& contacts, fem::Kinematics kinematics,
                                 const Communicator& comm)
{
  const auto mine = touches(contacts);
  std::vector<Global> nodes;
  for (const auto& pair : pairs) {
    nodes.insert(nodes.end(), pair.secondary.node_id.begin(), pair.secondary.node_id.end());
    if (pair.primary) nodes.insert(nodes.end(), pair.primary->node_id.begin(), pair.primary->node_id.end());
  }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  const auto known = answer(by_node(std::span<const Touch>(mine), comm), ask(nodes, comm), comm);
  const auto looks = [&](const mesh::Surface& surface, std::size_t face, int contact, int side) {
    Point normal = Point::Zero();
    for (const auto& at : quadrature({{contact, side, 0}, &surface, face}, kinematics)) normal += at.normal;
    normal.normalize();
    return std::ranges::any_of(surface.faces[face], [&](Local n) {
      const Global node = surface.node_id[static_cast<std::size_t>(n)];
      Point sum = Point::Zero();
      auto at = std::lower_bound(known.begin(), known.end(), node, [](const Touch& a, Global b) { return a.node < b; });
      for (; at != known.end() && at->node == node; ++at)
        if (at->contact == contact && at->side == side) sum += at->normal();
      return sum.dot(normal) > 0.5 * sum.norm();
    });
  };
  std::vector<TouchedFace> result;
  for (std::size_t c = 0; c < pairs.size(); ++c)
    for (const int side : {0, 1}) {
      if (pairs[c].options.law == Law::bonded || pairs[c].options.cyclic || (side == 0 && !pairs[c].primary)) continue;
      const mesh::Surface& surface = side == 1 ? pairs[c].secondary : *pairs[c].primary;
      const auto count = result.size();
      const Key key{static_cast<int>(c), side, 0};
      for (std::size_t f = 0; f < surface.faces.size(); ++f)
        if (looks(surface, f, key.contact, side)) result.push_back({{key.contact, side, surface.body[f]}, &surface, f});
      if (comm.any(result.size() > count)) continue;
      for (std::size_t f = 0; f < surface.faces.size(); ++f)
        result.push_back({{key.contact, side, surface.body[f]}, &surface, f});
    }
  return result;
}

// The mean squared angle between a face and the mean of those at its nodes.
struct Tilt {
  double kinks_apart = 0, whole = 0;
};

std::vector<Tilt> tilts(const std::vector<TouchedFace>& faces, bool solid, const Communicator& comm)
{
  struct Normal {
    Global node;
    int contact, side;
    Global face;
    double x, y, z;
    Point vector() const { return {x, y, z}; }
  };
  std::vector<Normal> mine;
  std::vector<Global> nodes;
  for (const auto& face : faces) {
    const auto& functions = mesh::shape_functions(face.surface->faces.type[face.face]);
    const auto local = face.surface->faces[face.face];
    Eigen::VectorXd value(functions.count());
    Eigen::MatrixXd gradient;
    for (std::size_t i = 0; i < local.size(); ++i) {
      gradient.setZero(functions.count(), solid ? 2 : 1);
      functions.evaluate(functions.nodes()[i], value, &gradient);
      const Point n = normal_of(gradient, *face.surface, face.face, solid).normalized();
      const Global node = face.surface->node_id[static_cast<std::size_t>(local[i])];
      mine.push_back({node, face.key.contact, face.key.side, face.surface->face_id[face.face], n[0], n[1], n[2]});
      nodes.push_back(node);
    }
  }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  const auto around = answer(by_node(std::span<const Normal>(mine), comm), ask(nodes, comm), comm);
  std::vector<Tilt> result;
  auto own = mine.begin();
  for (const auto& face : faces) {
    Tilt sum;
    const auto count = face.surface->faces[face.face].size();
    for (std::size_t i = 0; i < count; ++i, ++own) {
      Point mean = Point::Zero(), of_all = Point::Zero();
      auto at =
          std::lower_bound(around.begin(), around.end(), own->node, [](const Normal& a, Global node) { return a.node < node; });
      for (; at != around.end() && at->node == own->node; ++at)
        if (at->contact == own->contact && at->side == own->side) {
          of_all += at->vector();
          if (at->vector().dot(own->vector()) > edge_cosine) mean += at->vector();
        }
      sum.kinks_apart += (own->vector() - mean.normalized()).squaredNorm() / static_cast<double>(count);
      sum.whole += (own->vector() - of_all.normalized()).squaredNorm() / static_cast<double>(count);
    }
    result.push_back(sum);
  }
  return result;
}

// n . v of the six motions.
Eigen::Matrix<double, 6, 1> normal_speed(const SlidingSurface& slide, const Point& x, const Point& normal)
{
  Eigen::Matrix<double, 6, 1> result;
  result << normal, (x - slide.centre).cross(normal) / slide.length;
  return result;
}

// Sum of |v|^2 over the three axes as a form: of w x r it is |w|^2 |r|^2 - (w . r)^2.
SlidingSurface::Form speed(const SlidingSurface& slide, const Point& x)
{
  const Point r = (x - slide.centre) / slide.length;
  Eigen::Matrix<double, 3, 6> v;
  for (int k = 0; k < 3; ++k) {
    v.col(k) = Point::Unit(k);
    v.col(3 + k) = Point(Point::Unit(k)).cross(r);
  }
  return v.transpose() * v;
}

constexpr int terms = 10;
using Terms = Eigen::Matrix<double, terms, 1>;

Terms polynomials(const SlidingSurface& slide, const Point& x)
{
  const Point r = (x - slide.centre) / slide.length;
  Terms result;
  result << 1, r[0], r[1], r[2], r[0] * r[0], r[1] * r[1], r[2] * r[2], r[0] * r[1], r[1] * r[2], r[0] * r[2];
  return result;
}

// Fewer faces cannot tell facets from what they stand for.
constexpr double enough_faces = 20;

struct Sums {
  Eigen::Matrix<double, terms, terms> gram = Eigen::Matrix<double, terms, terms>::Zero();
  Eigen::Matrix<double, terms, 6> mixed = Eigen::Matrix<double, terms, 6>::Zero();
  SlidingSurface::Form whole = SlidingSurface::Form::Zero(), speed = SlidingSurface::Form::Zero(),
                       of_faces = SlidingSurface::Form::Zero();
};
static_assert(sizeof(Sums) == sizeof(double) * (100 + 60 + 3 * 36));

std::vector<Key> all_keys(const std::vector<TouchedFace>& faces, const Communicator& comm)
{
  std::vector<Key> keys;
  for (const auto& face : faces) keys.push_back(face.key);
  const auto unique = [&] {
    std::sort(keys.begin(), keys.end());
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  };
  unique();
  keys = comm.all_gather(keys);
  unique();
  return keys;
}

// What its faces come to in all.
struct SlidingExtent {
  double area, x, y, z, square, tilt, tilt_with_kinks, faces;
};

// The faces of this rank, and of each the place of its surface among all.
struct SlidingFaces {
  std::vector<TouchedFace> faces;
  std::vector<std::size_t> surface;
  fem::Kinematics kinematics;

  // Calls visit(surface, point of quadrature) for all points of all faces.
  template <class Visit>
  void for_each_point(const Visit& visit) const
  {
    for (std::size_t f = 0; f < faces.size(); ++f)
      for (const auto& at : quadrature(faces[f], kinematics)) visit(f, surface[f], at);
  }
};

std::vector<SlidingExtent> extents_of(const SlidingFaces& all, const std::vector<Tilt>& tilt, std::size_t surfaces,
                                      const Communicator& comm)
{
  std::vector<SlidingExtent> extents(surfaces, SlidingExtent{});
  for (const std::size_t k : all.surface) extents[k].faces += 1;
  all.for_each_point([&](std::size_t face, std::size_t k, const auto& at) {
    auto& e = extents[k];
    const double w = at.normal.norm();
    e.area += w;
    e.x += w * at.x[0], e.y += w * at.x[1], e.z += w * at.x[2];
    e.tilt += w * tilt[face].kinks_apart;
    e.tilt_with_kinks += w * tilt[face].whole;
  });
  comm.sum_in_place({reinterpret_cast<double*>(extents.data()), extents.size() * 8});
  return extents;
}

// Their lengths, from the mean square of the distances from their centres.
void set_lengths(const SlidingFaces& all, const std::vector<SlidingExtent>& extents, const Communicator& comm,
                 std::vector<SlidingSurface>& surfaces)
{
  std::vector<double> squares(surfaces.size(), 0.0);
  all.for_each_point([&](std::size_t, std::size_t k, const auto& at) {
    squares[k] += at.normal.norm() * (at.x - surfaces[k].centre).squaredNorm();
  });
  comm.sum_in_place(squares);
  for (std::size_t k = 0; k < surfaces.size(); ++k)
    surfaces[k].length = std::sqrt(std::max(squares[k] / extents[k].area, 1e-300));
}

void set_speeds(const SlidingFaces& all, const std::vector<SlidingExtent>& extents, const Communicator& comm,
                std::vector<SlidingSurface>& surfaces)
{
  std::vector<Sums> sums(surfaces.size());
  struct OfFace {
    Eigen::Matrix<double, 6, 1> speed = Eigen::Matrix<double, 6, 1>::Zero();  // integral of n . v
    double area = 0;
  };
  std::vector<OfFace> of_face(all.faces.size());
  all.for_each_point([&](std::size_t f, std::size_t k, const auto& at) {
    const double w = at.normal.norm();
    const auto speed_here = normal_speed(surfaces[k], at.x, at.normal / w);
    of_face[f].speed += w * speed_here;
    of_face[f].area += w;
    const Terms p = polynomials(surfaces[k], at.x);
    sums[k].gram += w * p * p.transpose();
    sums[k].mixed += w * p * speed_here.transpose();
    sums[k].whole += w * speed_here * speed_here.transpose();
    sums[k].speed += w * speed(surfaces[k], at.x);
  });
  for (std::size_t f = 0; f < of_face.size(); ++f)
    sums[all.surface[f]].of_faces += of_face[f].speed * of_face[f].speed.transpose() / of_face[f].area;
  comm.sum_in_place({reinterpret_cast<double*>(sums.data()), sums.size() * sizeof(Sums) / sizeof(double)});
  for (std::size_t k = 0; k < surfaces.size(); ++k) {
    auto& slide = surfaces[k];
    slide.whole = sums[k].whole / extents[k].area;
    slide.of_faces = sums[k].of_faces / extents[k].area;
    slide.smooth = slide.whole;
    if (extents[k].faces >= enough_faces)
      slide.smooth = sums[k].mixed.transpose() * dense::minimum_norm(sums[k].gram, sums[k].mixed) / extents[k].area;
    slide.speed = sums[k].speed / extents[k].area;
  }
}

}  // namespace

std::vector<SlidingSurface> sliding_surfaces(std::span<const Pair> pairs, const constraint::Contacts& contacts,
                                             fem::Kinematics kinematics, const Communicator& comm)
{
  SlidingFaces all{touched(pairs, contacts, kinematics, comm), {}, kinematics};
  const auto tilt = tilts(all.faces, kinematics == fem::Kinematics::solid, comm);
  const auto keys = all_keys(all.faces, comm);
  for (const auto& face : all.faces)
    all.surface.push_back(static_cast<std::size_t>(std::lower_bound(keys.begin(), keys.end(), face.key) - keys.begin()));
  const auto extents = extents_of(all, tilt, keys.size(), comm);
  std::vector<SlidingSurface> result;
  for (std::size_t k = 0; k < keys.size(); ++k) {
    const auto& e = extents[k];
    SlidingSurface slide;
    slide.contact = keys[k].contact;
    slide.secondary = keys[k].side == 1;
    slide.body = keys[k].body;
    slide.centre = Point(e.x, e.y, e.z) / e.area;
    slide.tilt = e.tilt / e.area;
    slide.tilt_with_kinks = e.tilt_with_kinks / e.area;
    result.push_back(slide);
  }
  set_lengths(all, extents, comm, result);
  set_speeds(all, extents, comm, result);
  return result;
}

}  // namespace mortise::contact
