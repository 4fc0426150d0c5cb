#include "side.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

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

// Corrects the normals of places on a border; see find_places().
void continue_curvature(const Side& side, Places& places)
{
  // Edges from place to place and how many faces have them.
  std::map<std::pair<Local, Local>, int> edges;
  for (std::size_t f = 0; f < side.faces.size(); ++f) {
    const auto begin = static_cast<std::size_t>(side.faces.offset[f]), n = side.faces[f].size();
    for (std::size_t k = 0; k < n; ++k) {
      const Local a = places.of_corner[begin + k], b = places.of_corner[begin + (k + 1) % n];
      if (n == 2 && k == 1) continue;
      ++edges[{a, b}];
      ++edges[{b, a}];
    }
  }
  const bool plane = side.faces.size() > 0 && side.faces.type[0] == mesh::CellType::line2;
  std::vector<int> degree(places.all.size(), 0);
  std::vector<bool> border(places.all.size(), false);
  for (const auto& [edge, count] : edges) {
    ++degree[static_cast<std::size_t>(edge.first)];
    if (!plane && count == 1) border[static_cast<std::size_t>(edge.first)] = true;
  }
  if (plane)
    for (std::size_t p = 0; p < border.size(); ++p) border[p] = degree[p] < 2;

  // First from edges that lead inside; then corners, which have none, from their neighbours on the border.
  std::vector<bool> known(border.size());
  for (std::size_t p = 0; p < border.size(); ++p) known[p] = !border[p];
  for (int pass = 0; pass < 2; ++pass) {
    std::vector<bool> reached = known;
    for (int sweep = 0; sweep < 10; ++sweep)
      for (const auto& [edge, count] : edges) {
        const auto a = static_cast<std::size_t>(edge.first), b = static_cast<std::size_t>(edge.second);
        if (known[a] || !known[b]) continue;
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

}  // namespace

double bulge(const FaceGeometry& face, std::span<const Point> normals, const Eigen::Vector4d& shape)
{
  const auto n = face.nodes.size();
  const auto rise = [&](std::size_t i, std::size_t j) {
    return (face.nodes[j] - face.nodes[i]).dot(normals[j] - normals[i]) / 8;
  };
  if (n == 2) return 4 * shape[0] * shape[1] * rise(0, 1);
  double result = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t j = (i + 1) % n;
    const auto a = static_cast<Eigen::Index>(i), b = static_cast<Eigen::Index>(j);
    if (n == 3) {
      result += 4 * shape[a] * shape[b] * rise(i, j);
    } else {  // on a quad N_i N_j = (1 - t^2)(1 + s)^2 / 16 along edge ij, whose own function is (1 - t^2)(1 + s) / 2
      const double across = shape[a] + shape[b];
      if (across > 1e-12) result += 4 * shape[a] * shape[b] / across * rise(i, j);
    }
  }
  return result;
}

FaceGeometry Side::geometry(std::size_t face) const
{
  FaceGeometry result{faces.type[face], {}};
  for (const Local n : faces[face]) result.nodes.push_back(points[static_cast<std::size_t>(n)]);
  return result;
}

Side gather(const mesh::Surface& surface, const Communicator& comm)
{
  struct Node {
    Global id;
    double x[3];
  };
  struct Face {
    Global id;
    Global nodes[4];
    mesh::CellType type;
  };
  std::vector<Node> nodes;
  for (std::size_t i = 0; i < surface.node_id.size(); ++i)
    nodes.push_back({surface.node_id[i], {surface.points[i][0], surface.points[i][1], surface.points[i][2]}});
  std::vector<Face> faces;
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    Face face{surface.face_id[f], {-1, -1, -1, -1}, surface.faces.type[f]};
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
  return side;
}

Places find_places(const Side& side)
{
  struct Corner {
    Local face;
    std::size_t k;
  };
  std::vector<std::vector<Corner>> round(side.points.size());
  for (std::size_t f = 0; f < side.faces.size(); ++f)
    for (std::size_t k = 0; k < side.faces[f].size(); ++k)
      round[static_cast<std::size_t>(side.faces[f][k])].push_back({static_cast<Local>(f), k});

  Places places;
  places.of_corner.resize(side.faces.nodes.size());
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
        places.of_corner[static_cast<std::size_t>(side.faces.offset[static_cast<std::size_t>(corners[a].face)]) + corners[a].k] =
            static_cast<Local>(places.all.size());
      }
      if (normal.squaredNorm() > 0) places.all.push_back({static_cast<Local>(n), normal.normalized()});
    }
  }
  continue_curvature(side, places);
  return places;
}

}  // namespace mortise::contact
