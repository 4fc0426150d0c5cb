#include "surface/side.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <map>

#include "base/dense.hpp"
#include "mesh/shape_functions.hpp"

namespace mortise::contact {

namespace {

// How a face is cut into facets between its nodes.
struct Facet {
  mesh::CellType type;
  std::array<int, 4> nodes;
};

const std::vector<Facet>& facets_of_face(mesh::CellType type)
{
  using enum mesh::CellType;
  static const std::map<mesh::CellType, std::vector<Facet>> table{
      {line2, {{line2, {0, 1}}}},
      {tri3, {{tri3, {0, 1, 2}}}},
      {quad4, {{quad4, {0, 1, 2, 3}}}},
      {line3, {{line2, {0, 2}}, {line2, {2, 1}}}},
      {tri6, {{tri3, {0, 3, 5}}, {tri3, {3, 1, 4}}, {tri3, {5, 4, 2}}, {tri3, {3, 4, 5}}}},
      {quad8, {{tri3, {0, 4, 7}}, {tri3, {4, 1, 5}}, {tri3, {5, 2, 6}}, {tri3, {6, 3, 7}}, {quad4, {4, 5, 6, 7}}}},
      {quad9, {{quad4, {0, 4, 8, 7}}, {quad4, {4, 1, 5, 8}}, {quad4, {8, 5, 2, 6}}, {quad4, {7, 8, 6, 3}}}},
  };
  return table.at(type);
}

// Whether all nodes lie where an affine map of the reference face puts them.
bool is_affine(mesh::CellType type, const Few<Point, 9>& nodes)
{
  double size = 0, error = 0;
  for (const auto& p : nodes) size = std::max(size, (p - nodes[0]).norm());
  const auto corners = static_cast<std::size_t>(mesh::corner_count(type));
  if (corners == 4) error = (nodes[0] - nodes[1] + nodes[2] - nodes[3]).norm();
  for (std::size_t m = 0; m < mesh::middles(type).size(); ++m) {
    Point sum = Point::Zero();
    for (const int c : mesh::middles(type)[m]) sum += nodes[static_cast<std::size_t>(c)];
    error = std::max(error, (nodes[corners + m] - sum / static_cast<double>(mesh::middles(type)[m].size())).norm());
  }
  return error <= 1e-9 * size;
}

void cut_into_facets(Side& side)
{
  side.first_facet.push_back(0);
  for (std::size_t f = 0; f < side.faces.size(); ++f) {
    const auto nodes = side.faces[f];
    Few<Point, 9> points;
    for (const Local n : nodes) points.push_back(side.points[static_cast<std::size_t>(n)]);
    side.affine.push_back(is_affine(side.faces.type[f], points));
    for (const auto& facet : facets_of_face(side.faces.type[f])) {
      Few<Local, 4> corners;
      for (int k = 0; k < mesh::node_count(facet.type); ++k)
        corners.push_back(nodes[static_cast<std::size_t>(facet.nodes[static_cast<std::size_t>(k)])]);
      side.facets.add(facet.type, corners);
      side.face_of.push_back(static_cast<Local>(f));
      side.corners.push_back(facet.nodes);
    }
    side.first_facet.push_back(static_cast<Local>(side.facets.size()));
  }
}

// In the order of their numbers.
void each_once(std::vector<SentNode>& nodes)
{
  std::ranges::sort(nodes, {}, &SentNode::id);
  nodes.erase(std::ranges::unique(nodes, {}, &SentNode::id).begin(), nodes.end());
}

// Of all ranks. Collective.
SentSurface from_all(const SentSurface& mine, const Communicator& comm)
{
  SentSurface all;
  unpack(comm.all_gather(pack(mine)), all);
  return all;
}

}  // namespace

FaceGeometry Side::geometry(std::size_t facet) const
{
  FaceGeometry result{facets.type[facet], {}};
  for (const Local n : facets[facet]) result.nodes.push_back(points[static_cast<std::size_t>(n)]);
  return result;
}

double Side::thickness(std::size_t facet, const Eigen::Vector4d& shape) const
{
  if (kinematics != fem::Kinematics::axisymmetric) return fem::thickness(kinematics, 0);
  double x = 0;
  for (std::size_t k = 0; k < facets[facet].size(); ++k)
    x += shape[static_cast<Eigen::Index>(k)] * points[static_cast<std::size_t>(facets[facet][k])][0];
  return fem::thickness(kinematics, x);
}

FaceShape Side::shape_in_face(std::size_t facet, const Eigen::Vector4d& shape, const Frame& frame, const Plane& at) const
{
  const auto face = static_cast<std::size_t>(face_of[facet]);
  const auto nodes = faces[face];
  const auto n = static_cast<Eigen::Index>(nodes.size());
  if (!second_order(face)) return shape.head(n);
  const auto& functions = mesh::shape_functions(faces.type[face]);
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < facets[facet].size(); ++k)
    place += shape[static_cast<Eigen::Index>(k)] * functions.nodes()[static_cast<std::size_t>(corners[facet][k])];
  FaceShape value(n);
  if (affine[face]) {
    functions.evaluate(place, value);
    return value;
  }
  // Newton's method in the auxiliary plane, from the place in the facet.
  const Eigen::Index d = mesh::dimension(faces.type[face]);
  Eigen::MatrixXd gradient;
  Eigen::Matrix<double, 2, Eigen::Dynamic, 0, 2, most_functions> plane(2, n);
  for (Eigen::Index i = 0; i < n; ++i)
    plane.col(i) = frame.project(points[static_cast<std::size_t>(nodes[static_cast<std::size_t>(i)])]);
  for (int step = 0; step < 20; ++step) {
    functions.evaluate(place, value, &gradient);
    Eigen::Matrix2d jacobian = Eigen::Matrix2d::Identity();
    jacobian.topLeftCorner(d, d) = plane.topRows(d).lazyProduct(gradient);
    Plane rest = Plane::Zero();
    rest.head(d) = (at - plane.lazyProduct(value)).head(d);
    const Plane change = jacobian.inverse() * rest;
    if (!(change.norm() < 1)) break;  // a face that hides behind itself; the facet's place must do
    place.head<2>() += change;
    if (change.squaredNorm() < 1e-28) break;
  }
  functions.evaluate(place, value);
  return value;
}

Side assemble(std::vector<SentNode> nodes, std::vector<SentFace>& faces, fem::Kinematics kinematics)
{
  each_once(nodes);
  std::sort(faces.begin(), faces.end(), [](const SentFace& a, const SentFace& b) { return a.id < b.id; });

  Side side;
  side.kinematics = kinematics;
  for (const auto& node : nodes) {
    side.node_id.push_back(node.id);
    side.points.emplace_back(node.x[0], node.x[1], node.x[2]);
  }
  for (const auto& face : faces) {
    Few<Local, 9> local;
    for (const Global id : face.nodes)
      if (id >= 0)
        local.push_back(
            static_cast<Local>(std::lower_bound(side.node_id.begin(), side.node_id.end(), id) - side.node_id.begin()));
    side.faces.add(face.type, local);
    side.face_id.push_back(face.id);
  }
  cut_into_facets(side);
  return side;
}

Side gather(const mesh::Surface& surface, fem::Kinematics kinematics, const Communicator& comm)
{
  return gather_with_bodies(surface, kinematics, comm).first;
}

std::pair<Side, std::vector<int>> gather_with_bodies(const mesh::Surface& surface, fem::Kinematics kinematics,
                                                     const Communicator& comm)
{
  SentSurface mine;
  for (std::size_t i = 0; i < surface.node_id.size(); ++i) mine.nodes.push_back(pack_node(surface, i));
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    mine.faces.push_back(pack_face(surface, f));
    if (!surface.body.empty()) mine.faces.back().mark = surface.body[f];
  }
  auto all = from_all(mine, comm);
  std::pair<Side, std::vector<int>> result{assemble(std::move(all.nodes), all.faces, kinematics), {}};
  for (const auto& face : all.faces) result.second.push_back(face.mark);
  return result;
}

std::vector<Point> gather_points(const mesh::Surface& surface, const Communicator& comm)
{
  SentSurface mine;
  for (std::size_t i = 0; i < surface.node_id.size(); ++i) mine.nodes.push_back(pack_node(surface, i));
  return points_in_order(from_all(mine, comm).nodes);
}

std::vector<Point> points_in_order(std::vector<SentNode> nodes)
{
  each_once(nodes);
  std::vector<Point> points;
  for (const auto& node : nodes) points.emplace_back(node.x[0], node.x[1], node.x[2]);
  return points;
}

}  // namespace mortise::contact
