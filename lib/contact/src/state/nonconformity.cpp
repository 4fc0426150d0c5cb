#include "contact/nonconformity.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "base/dense.hpp"
#include "integrals/common_parts.hpp"
#include "integrals/pieces.hpp"
#include "rows/by_node.hpp"
#include "search/share.hpp"

namespace mortise::contact {

namespace {

// Of a face's size, squared: parts thinner than this say nothing of derivatives.
constexpr double thinnest_part = 1e-6;

// A node of a secondary side that presses, and whether it sticks.
struct PressedNode {
  Global node;
  bool sticks;
};

bool counts(const Pair& pair)
{
  return pair.primary && !pair.options.obstacle && !pair.options.preload && !pair.options.cyclic;
}

// Of a side's nodes, with zeros where nothing is known. Collective.
std::vector<Point> displacements_of(const Side& side, const std::vector<NodalDisplacement>& known, const Communicator& comm)
{
  std::vector<Point> result(side.node_id.size(), Point::Zero());
  for (const auto& found : answer(known, ask(side.node_id, comm), comm)) {
    const auto at = std::lower_bound(side.node_id.begin(), side.node_id.end(), found.node);
    result[static_cast<std::size_t>(at - side.node_id.begin())] = unpacked(found.u);
  }
  return result;
}

// Of each node of a side what it does. `mine`: nodes of this rank's faces. Collective.
std::vector<Status> statuses_of(const Side& side, const std::vector<PressedNode>& mine, const Communicator& comm)
{
  std::vector<Status> result(side.node_id.size(), Status::open);
  for (const auto& found : answer(by_node<PressedNode>(mine, comm), ask(side.node_id, comm), comm)) {
    const auto at = std::lower_bound(side.node_id.begin(), side.node_id.end(), found.node);
    result[static_cast<std::size_t>(at - side.node_id.begin())] = found.sticks ? Status::stick : Status::slip;
  }
  return result;
}

// One side of a contact on this rank, with what its nodes do.
struct MovedSide {
  const Side& side;
  std::vector<Point> u;

  Point at(std::size_t face, const FaceShape& phi) const
  {
    Point sum = Point::Zero();
    const auto nodes = side.faces[face];
    for (std::size_t k = 0; k < nodes.size(); ++k)
      sum += phi[static_cast<Eigen::Index>(k)] * u[static_cast<std::size_t>(nodes[k])];
    return sum;
  }
};

// The faces of the secondary side, one after the other.
class Faces {
 public:
  Faces(const Share& share, double reach, MovedSide secondary, MovedSide primary, std::vector<Status> status)
      : secondary_(std::move(secondary)),
        primary_(std::move(primary)),
        status_(std::move(status)),
        tree_(tree_of_facets(share.primary)),
        sight_(share.secondary, share.primary, tree_),
        common_parts_(share.secondary, share.primary, tree_, sight_, reach)
  {
  }

  bool presses(std::size_t face) const
  {
    return std::ranges::any_of(side().faces[face], [&](Local n) { return status_at(n) != Status::open; });
  }

  // `bonded`: no jump is allowed at all.
  void add(std::size_t face, bool bonded, Nonconformity& sum)
  {
    sample(face);
    if (samples_.empty()) return;
    const Eigen::MatrixXd seen = dense::minimum_norm(gram_, moments_);
    const auto nodes = side().faces[face];
    const bool held = std::ranges::all_of(nodes, [&](Local n) { return status_at(n) == Status::stick; });
    double squared = 0, gradient = 0;  // integrals of w^2 and of its derivatives' squares
    for (std::size_t first = 0, end; first < samples_.size(); first = end) {
      end = first;
      while (end < samples_.size() && samples_[end].part == samples_[first].part) ++end;
      for (std::size_t i = first; i < end; ++i) {
        auto& s = samples_[i];
        const Point left = s.jump - seen.transpose() * s.theta;
        double pressed = 0, stuck = 0;  // parts of the face, about
        for (std::size_t k = 0; k < nodes.size(); ++k) {
          const double part = s.theta[static_cast<Eigen::Index>(k)];
          if (status_at(nodes[k]) != Status::open) pressed += part;
          if (status_at(nodes[k]) == Status::stick) stuck += part;
        }
        double across = std::clamp(pressed, 0.0, 1.0) * left.dot(normal_);
        Point tangential = std::clamp(stuck, 0.0, 1.0) * left;
        if (bonded && held) across = s.jump.dot(normal_), tangential = s.jump;
        tangential -= tangential.dot(normal_) * normal_;
        s.w = across * normal_ + tangential;
        squared += s.weight * s.w.squaredNorm();
        if (const double off = std::max(std::abs(across), tangential.norm()); off > sum.largest) sum.largest = off, sum.at = s.at;
      }
      gradient += squared_gradient(std::span(samples_).subspan(first, end - first));
    }
    sum.squared += std::max(squared / size_, std::sqrt(squared * gradient) / (2 * std::numbers::pi));
  }

 private:
  struct Sample {
    double weight;
    Point jump, at;
    FaceShape theta;
    std::size_t part;  // which part in common
    Plane place;       // in its plane
    Point w = Point::Zero();
  };

  // The integral over a part in common, w being about linear there.
  double squared_gradient(std::span<const Sample> samples) const
  {
    double area = 0;
    Plane middle = Plane::Zero();
    Point mean = Point::Zero();
    for (const auto& s : samples) area += s.weight, middle += s.weight * s.place, mean += s.weight * s.w;
    if (!(area > 0)) return 0;
    middle /= area, mean /= area;
    Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
    Eigen::Matrix<double, 2, 3> moments = Eigen::Matrix<double, 2, 3>::Zero();
    for (const auto& s : samples) {
      const Plane off = s.place - middle;
      spread += s.weight / area * off * off.transpose();
      moments += s.weight / area * off * (s.w - mean).transpose();
    }
    const auto [values, axes] = dense::plane_eigenpairs(spread);
    double result = 0;
    for (int i = 0; i < 2; ++i)
      if (values[i] > thinnest_part * size_ * size_)
        result += (axes.col(i).transpose() * moments).squaredNorm() / (values[i] * values[i]);
    return area * result;
  }

  const Side& side() const { return secondary_.side; }
  Status status_at(Local node) const { return status_[static_cast<std::size_t>(node)]; }

  // The mean normal of a face, and its size.
  void measure(std::size_t face)
  {
    Point sum = Point::Zero();
    double area = 0;
    for (auto facet = side().first_facet[face]; facet < side().first_facet[face + 1]; ++facet) {
      const FaceGeometry geometry = side().geometry(static_cast<std::size_t>(facet));
      const double part = geometry.type == mesh::CellType::line2 ? geometry.size() : geometry.area();
      sum += part * geometry.normal();
      area += part;
    }
    size_ = mesh::corner_count(side().faces.type[face]) == 2 ? area : std::sqrt(area);
    normal_ = sum.normalized();
  }

  void sample(std::size_t face)
  {
    measure(face);
    const auto& basis = multiplier_basis(side().faces.type[face]);
    const auto n = basis.rows();
    samples_.clear();
    gram_.setZero(n, n);
    moments_.setZero(n, 3);
    std::size_t parts = 0;
    for (auto f = side().first_facet[face]; f < side().first_facet[face + 1]; ++f) {
      const auto facet = static_cast<std::size_t>(f);
      const FaceGeometry geometry = side().geometry(facet);
      common_parts_.each(facet, false, common_, [&](std::size_t other) {
        const auto other_face = static_cast<std::size_t>(primary_.side.face_of[other]);
        for (const auto& point : common_.points) {
          const FaceShape phi = side().shape_in_face(facet, point.secondary, common_.frame, point.at);
          const FaceShape opposite = primary_.side.shape_in_face(other, point.primary, common_.frame, point.at);
          Point at = Point::Zero();
          for (std::size_t k = 0; k < geometry.nodes.size(); ++k)
            at += point.secondary[static_cast<Eigen::Index>(k)] * geometry.nodes[k];
          samples_.push_back({point.weight * side().thickness(facet, point.secondary),
                              secondary_.at(face, phi) - primary_.at(other_face, opposite), at, basis * phi, parts, point.at});
          const auto& s = samples_.back();
          gram_ += s.weight * s.theta * s.theta.transpose();
          moments_ += s.weight * s.theta * s.jump.transpose();
        }
        ++parts;
      });
    }
  }

  MovedSide secondary_, primary_;
  std::vector<Status> status_;  // of each secondary node
  Tree tree_;
  LineOfSight sight_;
  CommonParts common_parts_;
  Overlap common_;  // of the facet at work; what follows is of its face
  double size_ = 0;
  std::vector<Sample> samples_;
  Point normal_ = Point::Zero();
  Eigen::MatrixXd gram_, moments_;
};

// Of all ranks. Collective.
Nonconformity over_ranks(const Nonconformity& mine, const Communicator& comm)
{
  Nonconformity result{comm.sum(mine.squared), 0, Point::Zero()};
  for (const auto& other : comm.all_gather(std::vector{std::array{mine.largest, mine.at[0], mine.at[1], mine.at[2]}}))
    if (other[0] > result.largest) result.largest = other[0], result.at = Point(other[1], other[2], other[3]);
  return result;
}

}  // namespace

std::vector<Nonconformity> nonconformities(std::span<const Pair> pairs, std::span<const SurfaceState> surfaces,
                                           std::span<const NodalDisplacement> displacements, fem::Kinematics kinematics,
                                           const Communicator& comm)
{
  std::vector<Nonconformity> result(pairs.size());
  auto known = by_node(displacements, comm);
  const auto same = [](const NodalDisplacement& a, const NodalDisplacement& b) { return a.node == b.node; };
  known.erase(std::unique(known.begin(), known.end(), same), known.end());
  const auto sizes = measure(pairs, comm);
  for (std::size_t c = 0; c < pairs.size(); ++c) {
    if (!counts(pairs[c])) continue;
    std::vector<PressedNode> pressed;
    for (std::size_t i = 0; i < surfaces[c].pressure.size(); ++i)
      if (surfaces[c].status[i] != static_cast<int>(Status::open))
        pressed.push_back({pairs[c].secondary.node_id[i], surfaces[c].status[i] == static_cast<int>(Status::stick)});
    if (!comm.any(!pressed.empty())) continue;
    const Share share = share_out(pairs[c], sizes[c], kinematics, comm);
    Faces faces(share, sizes[c].reach, {share.secondary, displacements_of(share.secondary, known, comm)},
                {share.primary, displacements_of(share.primary, known, comm)}, statuses_of(share.secondary, pressed, comm));
    Nonconformity mine;
    for (std::size_t f = 0; f < share.secondary.faces.size(); ++f)
      if (share.own[static_cast<std::size_t>(share.secondary.faces[f][0])] && faces.presses(f))
        faces.add(f, pairs[c].options.law == Law::bonded, mine);
    result[c] = over_ranks(mine, comm);
  }
  return result;
}

}  // namespace mortise::contact
