#include "contact/proximity.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>

#include "integrals/overlap.hpp"
#include "search/tree.hpp"

namespace mortise::contact {

namespace {

double to_segment(const Point& x, const Point& a, const Point& b)
{
  const double square = (b - a).squaredNorm();
  const double t = square > 0 ? std::clamp((x - a).dot(b - a) / square, 0.0, 1.0) : 0.0;
  return (x - a - t * (b - a)).norm();
}

double to_triangle(const Point& x, const Point& a, const Point& b, const Point& c)
{
  const Point normal = (b - a).cross(c - a);
  const double square = normal.squaredNorm();
  if (square > 0) {
    const double u = (b - a).cross(x - a).dot(normal), v = (c - b).cross(x - b).dot(normal), w = (a - c).cross(x - c).dot(normal);
    if (u >= 0 && v >= 0 && w >= 0) return std::abs((x - a).dot(normal)) / std::sqrt(square);
  }
  return std::min({to_segment(x, a, b), to_segment(x, b, c), to_segment(x, c, a)});
}

double to_face(const Point& x, const FaceGeometry& face)
{
  const auto& n = face.nodes;
  if (n.size() == 2) return to_segment(x, n[0], n[1]);
  const double first = to_triangle(x, n[0], n[1], n[2]);
  return n.size() == 3 ? first : std::min(first, to_triangle(x, n[0], n[2], n[3]));
}

double between(const FaceGeometry& a, const FaceGeometry& b)
{
  double least = std::numeric_limits<double>::infinity();
  for (const auto& x : a.nodes) least = std::min(least, to_face(x, b));
  for (const auto& x : b.nodes) least = std::min(least, to_face(x, a));
  return least;
}

Box box_of(const FaceGeometry& face)
{
  Box box;
  for (const auto& x : face.nodes) box.extend(x);
  return box;
}

struct Face {
  FaceGeometry geometry;
  Box box;
  int body;
};

// The corners of faces, as plain bytes.
struct Sent {
  int body, corners;
  mesh::CellType type;
  std::array<double, 12> x;
};

std::vector<Face> faces_of(const std::vector<Sent>& sent)
{
  std::vector<Face> faces;
  for (const auto& s : sent) {
    FaceGeometry geometry{s.type, {}};
    for (std::size_t k = 0; k < static_cast<std::size_t>(s.corners); ++k)
      geometry.nodes.push_back({s.x[3 * k], s.x[3 * k + 1], s.x[3 * k + 2]});
    const Box box = box_of(geometry);
    faces.push_back({geometry, box, s.body});
  }
  return faces;
}

std::vector<Sent> pack(const mesh::Surface& skin, const std::vector<bool>& wanted)
{
  std::vector<Sent> sent;
  for (std::size_t f = 0; f < skin.faces.size(); ++f) {
    if (!wanted[static_cast<std::size_t>(skin.body[f])]) continue;
    const auto face = corners_of(skin, f);
    Sent s{skin.body[f], static_cast<int>(face.nodes.size()), face.type, {}};
    for (std::size_t k = 0; k < face.nodes.size(); ++k)
      for (std::size_t c = 0; c < 3; ++c) s.x[3 * k + c] = face.nodes[k][static_cast<Eigen::Index>(c)];
    sent.push_back(s);
  }
  return sent;
}

// Of this rank's faces the one that is next to a body.
Nearest nearest_here(int body, const std::vector<Face>& its, const std::vector<Face>& here)
{
  Box all;
  for (const auto& face : its) all.extend(face.box);
  std::vector<std::pair<double, std::size_t>> order;  // least distance that is possible, face
  for (std::size_t f = 0; f < here.size(); ++f)
    if (here[f].body != body) order.emplace_back(here[f].box.exteriorDistance(all), f);
  std::sort(order.begin(), order.end());
  Nearest best;
  for (const auto& [least, f] : order) {
    if (least > best.distance) break;
    for (const auto& face : its) {
      if (face.box.exteriorDistance(here[f].box) > best.distance) continue;
      const double distance = between(face.geometry, here[f].geometry);
      if (distance < best.distance || (distance == best.distance && here[f].body < best.body)) best = {here[f].body, distance};
    }
  }
  return best;
}

}  // namespace

std::vector<Nearest> nearest_bodies(const mesh::Surface& skin, const std::vector<bool>& wanted, const Communicator& comm)
{
  const auto gathered = faces_of(comm.all_gather(pack(skin, wanted)));
  const auto here = faces_of(pack(skin, std::vector<bool>(wanted.size(), true)));
  std::vector<Nearest> mine(wanted.size());
  for (std::size_t b = 0; b < wanted.size(); ++b) {
    if (!wanted[b]) continue;
    std::vector<Face> its;
    for (const auto& face : gathered)
      if (face.body == static_cast<int>(b)) its.push_back(face);
    mine[b] = nearest_here(static_cast<int>(b), its, here);
  }
  const auto all = comm.all_gather(mine);
  std::vector<Nearest> result(wanted.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    auto& best = result[i % wanted.size()];
    if (all[i].body >= 0 && (all[i].distance < best.distance || (all[i].distance == best.distance && all[i].body < best.body)))
      best = all[i];
  }
  return result;
}

}  // namespace mortise::contact
