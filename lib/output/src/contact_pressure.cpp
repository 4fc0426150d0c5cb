#include "output/contact_pressure.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <unordered_map>

#include "io/cell_field.hpp"

namespace mortise::output {

namespace {

using Pressures = std::unordered_map<Global, double>;  // of nodes of this rank

constexpr double beside = 0.05;  // diagonals of a face that a node may lie beside it
constexpr double apart = 1;      // and above or below it, for gaps, fits and overlaps

void keep_larger(Pressures& pressures, Global node, double value)
{
  auto& kept = pressures[node];
  kept = std::max(kept, value);
}

Eigen::AlignedBox3d box_of(std::span<const Point> points)
{
  Eigen::AlignedBox3d box;
  for (const auto& p : points) box.extend(p);
  return box;
}

struct Bounds {
  double low[3], high[3];
};

// The pressed faces of the secondary side that lie near this rank's part of the primary one. Collective.
io::CellArrays pressed_faces(const contact::Pair& pair, const contact::SurfaceState& state, const Communicator& comm)
{
  Bounds mine{{1, 1, 1}, {0, 0, 0}};  // of nothing
  if (pair.primary && !pair.primary->points.empty()) {
    const auto box = box_of(pair.primary->points);
    std::copy_n(box.min().data(), 3, mine.low);
    std::copy_n(box.max().data(), 3, mine.high);
  }
  const auto boxes = comm.all_gather(std::vector{mine});
  std::vector<std::vector<double>> send(boxes.size());  // type, and of each node its place and value
  const auto& side = pair.secondary;
  for (std::size_t f = 0; f < side.faces.size(); ++f) {
    const auto nodes = side.faces[f];
    std::vector<double> packed{static_cast<double>(side.faces.type[f])};
    std::vector<Point> points;
    bool pressed = false;
    for (const Local n : nodes) {
      const auto& x = points.emplace_back(side.points[static_cast<std::size_t>(n)]);
      const double value = state.recovered_pressure[static_cast<std::size_t>(n)];
      pressed = pressed || value > 0;
      packed.insert(packed.end(), {x[0], x[1], x[2], value});
    }
    if (!pressed) continue;
    auto box = box_of(points);
    const Point margin = Point::Constant(apart * box.diagonal().norm());
    box = Eigen::AlignedBox3d(Point(box.min() - margin), Point(box.max() + margin));
    for (std::size_t r = 0; r < boxes.size(); ++r)
      if (boxes[r].low[0] <= boxes[r].high[0] && box.intersects(Eigen::AlignedBox3d(Point(boxes[r].low), Point(boxes[r].high))))
        send[r].insert(send[r].end(), packed.begin(), packed.end());
  }
  io::CellArrays faces;
  for (const auto& part : comm.exchange(send))
    for (std::size_t i = 0; i < part.size();) {
      const auto type = static_cast<mesh::CellType>(part[i++]);
      std::vector<Point> points;
      std::vector<double> values;
      for (int n = 0; n < mesh::node_count(type); ++n, i += 4) {
        points.emplace_back(part[i], part[i + 1], part[i + 2]);
        values.push_back(part[i + 3]);
      }
      faces.add(points, values, type);
    }
  return faces;
}

// The unit normal of a face by its first corners, in a plane of an edge.
Point normal_of(const io::CellArrays& faces, std::size_t face, bool plane)
{
  const auto corner = [&](long long i) {
    return Point(
        &faces.points[3 * static_cast<std::size_t>(faces.connectivity[static_cast<std::size_t>(faces.offsets[face] + i)])]);
  };
  const Point along = corner(1) - corner(0);
  return (plane ? Point(-along[1], along[0], 0) : Point(along.cross(Point(corner(2) - corner(0))))).normalized();
}

void on_primary(const mesh::Surface& side, const io::CellArrays& faces, bool plane, Pressures& pressures)
{
  const io::CellField field(faces);
  for (std::size_t n = 0; n < side.points.size(); ++n) {
    const Point& x = side.points[n];
    const auto found = field.nearest(x);
    const Point away = x - found.at, normal = normal_of(faces, found.cell, plane);
    const double across = normal.dot(away);
    if (std::abs(across) > apart * found.size || (away - across * normal).norm() > beside * found.size) continue;
    keep_larger(pressures, side.node_id[n], found.value);
  }
}

}  // namespace

std::vector<Eigen::MatrixXd> contact_pressure(const partition::Decomposition& decomposition,
                                              const partition::Interface& interface, std::span<const contact::Pair> pairs,
                                              std::span<const contact::SurfaceState> surfaces, const Communicator& comm)
{
  Pressures pressures;
  for (std::size_t c = 0; c < pairs.size(); ++c) {
    const auto& side = pairs[c].secondary;
    for (std::size_t n = 0; n < side.points.size(); ++n)
      keep_larger(pressures, side.node_id[n], surfaces[c].recovered_pressure[n]);
    const auto faces = pressed_faces(pairs[c], surfaces[c], comm);
    if (pairs[c].primary && !faces.types.empty())
      on_primary(*pairs[c].primary, faces, decomposition.catalogue.dimension == 2, pressures);
  }
  // A node of two ranks may have its faces on one of them.
  std::vector<Eigen::MatrixXd> values;  // sum, and how many know it
  for (const auto& subdomain : decomposition.subdomains) {
    const auto& ids = subdomain.mesh.node_id;
    auto& own = values.emplace_back(Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(ids.size()), 2));
    for (std::size_t n = 0; n < ids.size(); ++n)
      if (const auto known = pressures.find(ids[n]); known != pressures.end())
        own.row(static_cast<Eigen::Index>(n)) << known->second, 1;
  }
  partition::sum_over_copies(decomposition, interface, values, comm);
  for (auto& own : values) {
    const Eigen::VectorXd mean = own.col(0).cwiseQuotient(own.col(1).cwiseMax(1.0));
    own = mean;
  }
  return values;
}

}  // namespace mortise::output
