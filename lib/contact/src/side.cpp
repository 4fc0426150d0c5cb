#include "side.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "mesh/shape_functions.hpp"

namespace mortise::contact {

namespace {

constexpr double kink = 0.766;  // cosine of the angle from which neighbouring faces make a kink

// Nelson Max's weight times normal at corner k of a face.
Point corner_normal(const FaceGeometry& face, std::size_t k)
{
  const auto n = face.nodes.size();
  if (face.type == mesh::CellType::line2) return face.normal() / face.area();
  const Point next = face.nodes[(k + 1) % n] - face.nodes[k], last = face.nodes[(k + n - 1) % n] - face.nodes[k];
  return next.cross(last) / (next.squaredNorm() * last.squaredNorm());
}

// Places of a border that goes on nearly straight there: its two edges turn by less than 45 degrees.
std::vector<bool> between_two_faces(const Side& side, const Places& places, const std::map<std::pair<Local, Local>, int>& edges)
{
  std::vector<std::vector<Point>> along(places.all.size());
  const auto at = [&](Local place) -> const Point& {
    return side.points[static_cast<std::size_t>(places.all[static_cast<std::size_t>(place)].node)];
  };
  for (const auto& [edge, count] : edges)
    if (count == 1) along[static_cast<std::size_t>(edge.first)].push_back((at(edge.second) - at(edge.first)).normalized());
  std::vector<bool> result;
  for (const auto& directions : along) result.push_back(directions.size() == 2 && directions[0].dot(directions[1]) < -0.7);
  return result;
}

// Corrects the normals of places on a border; see find_places().
void continue_curvature(const Side& side, Places& places)
{
  // Edges from place to place and how many faces have them.
  std::map<std::pair<Local, Local>, int> edges;
  for (std::size_t f = 0; f < side.facets.size(); ++f) {
    const auto begin = static_cast<std::size_t>(side.facets.offset[f]), n = side.facets[f].size();
    for (std::size_t k = 0; k < n; ++k) {
      const Local a = places.of_corner[begin + k], b = places.of_corner[begin + (k + 1) % n];
      if (n == 2 && k == 1) continue;
      ++edges[{a, b}];
      ++edges[{b, a}];
    }
  }
  const bool plane = side.facets.size() > 0 && side.facets.type[0] == mesh::CellType::line2;
  std::vector<int> degree(places.all.size(), 0);
  std::vector<bool> border(places.all.size(), false);
  for (const auto& [edge, count] : edges) {
    ++degree[static_cast<std::size_t>(edge.first)];
    if (!plane && count == 1) border[static_cast<std::size_t>(edge.first)] = true;
  }
  if (plane)
    for (std::size_t p = 0; p < border.size(); ++p) border[p] = degree[p] < 2;

  // First from edges that lead inside; then corners, which have none, from their neighbours on the border. On a surface one cell
  // wide all places are on the border: there those between two faces have the normal that the ends continue.
  const auto smooth = plane ? std::vector<bool>(border.size(), false) : between_two_faces(side, places, edges);
  std::vector<bool> known(border.size());
  for (std::size_t p = 0; p < border.size(); ++p) known[p] = !border[p];
  for (int pass = 0; pass < 2; ++pass) {
    std::vector<bool> reached = known;
    const auto leads = [&](std::size_t b, std::size_t a) { return known[b] || (pass == 1 && smooth[b] && !smooth[a]); };
    for (int sweep = 0; sweep < 10; ++sweep)
      for (const auto& [edge, count] : edges) {
        const auto a = static_cast<std::size_t>(edge.first), b = static_cast<std::size_t>(edge.second);
        if (known[a] || !leads(b, a)) continue;
        auto& place = places.all[a];
        const Place& inner = places.all[b];
        const Point along =
            (side.points[static_cast<std::size_t>(inner.node)] - side.points[static_cast<std::size_t>(place.node)]).normalized();
        place.normal = (place.normal - (place.normal.dot(along) + inner.normal.dot(along)) * along).normalized();
        reached[a] = true;
      }
    known = reached;
  }
}

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
bool is_affine(mesh::CellType type, const std::vector<Point>& nodes)
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
    std::vector<Point> points;
    for (const Local n : nodes) points.push_back(side.points[static_cast<std::size_t>(n)]);
    side.affine.push_back(is_affine(side.faces.type[f], points));
    for (const auto& facet : facets_of_face(side.faces.type[f])) {
      std::vector<Local> corners;
      for (int k = 0; k < mesh::node_count(facet.type); ++k)
        corners.push_back(nodes[static_cast<std::size_t>(facet.nodes[static_cast<std::size_t>(k)])]);
      side.facets.add(facet.type, corners);
      side.face_of.push_back(static_cast<Local>(f));
      side.corners.push_back(facet.nodes);
    }
    side.first_facet.push_back(static_cast<Local>(side.facets.size()));
  }
}

}  // namespace

Bulge::Bulge(const FaceGeometry& face, std::span<const Point> normals) : n_(face.nodes.size())
{
  for (std::size_t i = 0; i < n_; ++i) {
    const std::size_t j = (i + 1) % n_;
    rise_[i] = (face.nodes[j] - face.nodes[i]).dot(normals[j] - normals[i]) / 8;
  }
}

double Bulge::operator()(const Eigen::Vector4d& shape) const
{
  if (n_ == 2) return 4 * shape[0] * shape[1] * rise_[0];
  double result = 0;
  for (std::size_t i = 0; i < n_; ++i) {
    const auto a = static_cast<Eigen::Index>(i), b = static_cast<Eigen::Index>((i + 1) % n_);
    if (n_ == 3) {
      result += 4 * shape[a] * shape[b] * rise_[i];
    } else {  // on a quad N_i N_j = (1 - t^2)(1 + s)^2 / 16 along edge ij, whose own function is (1 - t^2)(1 + s) / 2
      const double across = shape[a] + shape[b];
      if (across > 1e-12) result += 4 * shape[a] * shape[b] / across * rise_[i];
    }
  }
  return result;
}

FaceGeometry Side::geometry(std::size_t facet) const
{
  FaceGeometry result{facets.type[facet], {}};
  for (const Local n : facets[facet]) result.nodes.push_back(points[static_cast<std::size_t>(n)]);
  return result;
}

double Side::thickness(std::size_t facet, const Eigen::Vector4d& shape) const
{
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
  Eigen::VectorXd value(n);
  if (affine[face]) {
    functions.evaluate(place, value);
    return value;
  }
  // Newton's method in the auxiliary plane, from the place in the facet.
  const Eigen::Index d = mesh::dimension(faces.type[face]);
  Eigen::MatrixXd gradient, plane(2, n);
  for (Eigen::Index i = 0; i < n; ++i)
    plane.col(i) = frame.project(points[static_cast<std::size_t>(nodes[static_cast<std::size_t>(i)])]);
  for (int step = 0; step < 20; ++step) {
    functions.evaluate(place, value, &gradient);
    const Eigen::MatrixXd jacobian = (plane * gradient).topRows(d);
    const Eigen::VectorXd change = jacobian.partialPivLu().solve((at - plane * value).head(d));
    if (!(change.norm() < 1)) break;  // a face that hides behind itself; the facet's place must do
    place.head(d) += change;
    if (change.squaredNorm() < 1e-28) break;
  }
  functions.evaluate(place, value);
  return value;
}

Side gather(const mesh::Surface& surface, fem::Kinematics kinematics, const Communicator& comm)
{
  struct Node {
    Global id;
    double x[3];
  };
  struct Face {
    Global id;
    Global nodes[9];
    mesh::CellType type;
  };
  std::vector<Node> nodes;
  for (std::size_t i = 0; i < surface.node_id.size(); ++i)
    nodes.push_back({surface.node_id[i], {surface.points[i][0], surface.points[i][1], surface.points[i][2]}});
  std::vector<Face> faces;
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    Face face{surface.face_id[f], {-1, -1, -1, -1, -1, -1, -1, -1, -1}, surface.faces.type[f]};
    const auto local = surface.faces[f];
    for (std::size_t k = 0; k < local.size(); ++k) face.nodes[k] = surface.node_id[static_cast<std::size_t>(local[k])];
    faces.push_back(face);
  }
  nodes = comm.all_gather(nodes);
  faces = comm.all_gather(faces);
  std::sort(nodes.begin(), nodes.end(), [](const Node& a, const Node& b) { return a.id < b.id; });
  nodes.erase(std::unique(nodes.begin(), nodes.end(), [](const Node& a, const Node& b) { return a.id == b.id; }), nodes.end());
  std::sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) { return a.id < b.id; });

  Side side;
  side.kinematics = kinematics;
  for (const auto& node : nodes) {
    side.node_id.push_back(node.id);
    side.points.emplace_back(node.x[0], node.x[1], node.x[2]);
  }
  for (const auto& face : faces) {
    std::vector<Local> local;
    for (const Global id : face.nodes)
      if (id >= 0)
        local.push_back(
            static_cast<Local>(std::lower_bound(side.node_id.begin(), side.node_id.end(), id) - side.node_id.begin()));
    side.faces.add(face.type, local);
  }
  cut_into_facets(side);
  return side;
}

Places find_places(const Side& side)
{
  struct Corner {
    Local face;
    std::size_t k;
  };
  std::vector<std::vector<Corner>> round(side.points.size());
  for (std::size_t f = 0; f < side.facets.size(); ++f)
    for (std::size_t k = 0; k < side.facets[f].size(); ++k)
      round[static_cast<std::size_t>(side.facets[f][k])].push_back({static_cast<Local>(f), k});

  Places places;
  places.of_corner.resize(side.facets.nodes.size());
  for (std::size_t n = 0; n < round.size(); ++n) {
    const auto& corners = round[n];
    std::vector<FaceGeometry> faces;
    std::vector<Point> normals;
    for (const auto& corner : corners) {
      faces.push_back(side.geometry(static_cast<std::size_t>(corner.face)));
      normals.push_back(faces.back().normal());
    }
    std::vector<std::size_t> group(corners.size());
    std::iota(group.begin(), group.end(), 0U);
    for (bool changed = true; changed;) {
      changed = false;
      for (std::size_t a = 0; a < corners.size(); ++a)
        for (std::size_t b = 0; b < a; ++b)
          if (group[a] != group[b] && normals[a].dot(normals[b]) > kink) {
            group[a] = group[b] = std::min(group[a], group[b]);
            changed = true;
          }
    }
    for (std::size_t g = 0; g < corners.size(); ++g) {
      Point normal = Point::Zero();
      for (std::size_t a = 0; a < corners.size(); ++a) {
        if (group[a] != g) continue;
        normal += corner_normal(faces[a], corners[a].k);
        places.of_corner[static_cast<std::size_t>(side.facets.offset[static_cast<std::size_t>(corners[a].face)]) + corners[a].k] =
            static_cast<Local>(places.all.size());
      }
      if (normal.squaredNorm() > 0) places.all.push_back({static_cast<Local>(n), normal.normalized()});
    }
  }
  continue_curvature(side, places);
  places.of_node.resize(side.faces.nodes.size());
  for (std::size_t f = 0; f < side.facets.size(); ++f)
    for (std::size_t k = 0; k < side.facets[f].size(); ++k)
      places
          .of_node[static_cast<std::size_t>(side.faces.offset[static_cast<std::size_t>(side.face_of[f])] + side.corners[f][k])] =
          places.of_corner[static_cast<std::size_t>(side.facets.offset[f]) + k];
  return places;
}

}  // namespace mortise::contact
