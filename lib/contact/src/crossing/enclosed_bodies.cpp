#include <algorithm>
#include <array>
#include <limits>
#include <set>
#include <tuple>

#include "contact/interpenetration.hpp"
#include "search/tree.hpp"
#include "surface/closest_point.hpp"

namespace mortise::contact {

namespace {

// Along no edge that a mesh is likely to have.
const Point no_axis_of_a_mesh = Point(0.5408, 0.3217, 0.7771).normalized();
const Point no_axis_in_a_plane = Point(0.8623, 0.5064, 0).normalized();

// The middle of the face of a body that is outermost along an axis, as plain bytes.
struct Outermost {
  int body, axis;  // 0 to 5: x, -x, y, ...
  double value;
  Global face;
  std::array<double, 3> now, before;
};

// Whether the line from x along `direction` crosses a triangle: 1 where it leaves the body, -1 where it enters, else 0.
int crossing_of_triangle(const Point& x, const Point& direction, const Point& a, const Point& b, const Point& c)
{
  const Point normal = (b - a).cross(c - a);
  const double along = direction.dot(normal);
  if (along == 0 || (a - x).dot(normal) / along < 0) return 0;
  const auto side = [&](const Point& from, const Point& to) { return direction.dot((from - x).cross(to - x)) > 0; };
  const bool first = side(a, b);
  return first == side(b, c) && first == side(c, a) ? (along > 0 ? 1 : -1) : 0;
}

int crossing_of_line(const Point& x, const Point& direction, const Point& a, const Point& b, const Point& normal)
{
  const double along = direction.dot(normal);
  if (along == 0 || (a - x).dot(normal) / along < 0) return 0;
  const auto side = [&](const Point& y) { return direction[0] * (y[1] - x[1]) - direction[1] * (y[0] - x[0]) > 0; };
  return side(a) != side(b) ? (along > 0 ? 1 : -1) : 0;
}

int crossings_of_face(const Point& x, const FaceGeometry& face)
{
  const auto& n = face.nodes;
  if (n.size() == 2) return crossing_of_line(x, no_axis_in_a_plane, n[0], n[1], face.normal());
  const int first = crossing_of_triangle(x, no_axis_of_a_mesh, n[0], n[1], n[2]);
  return n.size() == 3 ? first : first + crossing_of_triangle(x, no_axis_of_a_mesh, n[0], n[2], n[3]);
}

// Of all bodies, the same on every rank. Collective.
std::vector<Box> boxes_of_bodies(const mesh::Surface& skin, int bodies, const Communicator& comm)
{
  std::vector<std::array<double, 6>> mine(static_cast<std::size_t>(bodies));
  std::vector<Box> boxes(mine.size());
  const auto body_of = [&](std::size_t f) { return static_cast<std::size_t>(skin.body[f]); };
  for (std::size_t f = 0; f < skin.faces.size(); ++f)
    for (const Local n : skin.faces[f]) boxes[body_of(f)].extend(skin.points[static_cast<std::size_t>(n)]);
  for (std::size_t b = 0; b < mine.size(); ++b)
    for (int c = 0; c < 3; ++c) {
      mine[b][static_cast<std::size_t>(c)] = boxes[b].min()[c];
      mine[b][static_cast<std::size_t>(3 + c)] = boxes[b].max()[c];
    }
  const auto all = comm.all_gather(mine);
  for (std::size_t i = 0; i < all.size(); ++i)
    boxes[i % mine.size()].extend(Box(Point(all[i][0], all[i][1], all[i][2]), Point(all[i][3], all[i][4], all[i][5])));
  return boxes;
}

// Of these bodies, the same on every rank, by body and axis. Collective.
std::vector<Outermost> outermost_faces(const mesh::Surface& before, const mesh::Surface& now, const std::set<int>& bodies,
                                       int axes, const Communicator& comm)
{
  std::map<std::pair<int, int>, Outermost> best;
  const auto take = [&](const Outermost& face) {
    const auto [found, fresh] = best.emplace(std::pair(face.body, face.axis), face);
    if (!fresh && std::tuple(-face.value, face.face) < std::tuple(-found->second.value, found->second.face)) found->second = face;
  };
  for (std::size_t f = 0; f < now.faces.size(); ++f) {
    if (!bodies.contains(now.body[f])) continue;
    const Point x = corners_of(now, f).centre(), y = corners_of(before, f).centre();
    for (int axis = 0; axis < axes; ++axis)
      take({now.body[f], axis, axis % 2 ? -x[axis / 2] : x[axis / 2], now.face_id[f], {x[0], x[1], x[2]}, {y[0], y[1], y[2]}});
  }
  std::vector<Outermost> mine;
  for (const auto& [key, face] : best) mine.push_back(face);
  for (const auto& face : comm.all_gather(mine)) take(face);
  std::vector<Outermost> result;
  for (const auto& [key, face] : best) result.push_back(face);
  return result;
}

// Whether contacts have faces of both bodies on their two sides. Collective.
std::set<std::pair<int, int>> bodies_in_contact(const mesh::Surface& skin, const ContactSides& sides, const Communicator& comm)
{
  struct On {
    int side, body;
  };
  std::set<std::pair<int, int>> mine;
  for (std::size_t f = 0; f < skin.faces.size(); ++f)
    if (const auto found = sides.of_face.find(skin.face_id[f]); found != sides.of_face.end())
      for (const int side : found->second) mine.emplace(side, skin.body[f]);
  std::vector<On> sent;
  for (const auto& [side, body] : mine) sent.push_back({side, body});
  std::map<int, std::set<int>> on;
  for (const auto& [side, body] : comm.all_gather(sent)) on[side].insert(body);
  std::set<std::pair<int, int>> pairs;
  for (const auto& [side, those] : on)
    if (const auto others = on.find(side ^ 1); others != on.end())
      for (const int a : those)
        for (const int b : others->second) pairs.emplace(a, b);
  return pairs;
}

}  // namespace

std::vector<Interpenetration> find_enclosed_bodies(const mesh::Surface& before, const mesh::Surface& now, int bodies,
                                                   const std::function<ContactSides()>& sides, fem::Kinematics kinematics,
                                                   const Communicator& comm)
{
  const auto boxes = boxes_of_bodies(now, bodies, comm);
  std::vector<std::pair<int, int>> pairs;  // the inner body, the outer one
  std::set<int> inner;
  for (int a = 0; a < bodies; ++a)
    for (int b = 0; b < bodies; ++b)
      if (const auto& in = boxes[static_cast<std::size_t>(a)], &out = boxes[static_cast<std::size_t>(b)];
          a != b && !in.isEmpty() && out.contains(in)) {
        pairs.emplace_back(a, b);
        inner.insert(a);
      }
  if (pairs.empty()) return {};
  const int axes = 2 * fem::dimension(kinematics);
  const auto outermost = outermost_faces(before, now, inner, axes, comm);
  const auto place_of = [&](int body, int axis) {
    return std::find_if(outermost.begin(), outermost.end(), [&](const Outermost& o) { return o.body == body && o.axis == axis; });
  };
  std::map<int, std::vector<FaceGeometry>> faces;
  for (const auto& [a, b] : pairs) faces[b];
  for (std::size_t f = 0; f < now.faces.size(); ++f)
    if (const auto found = faces.find(now.body[f]); found != faces.end()) found->second.push_back(corners_of(now, f));
  // One axis after the other: of most bodies the first place is outside.
  for (int axis = 0; axis < axes && !pairs.empty(); ++axis) {
    std::vector<double> count(pairs.size(), 0.0);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const auto& x = place_of(pairs[i].first, axis)->now;
      for (const auto& face : faces[pairs[i].second]) count[i] += crossings_of_face(Point(x[0], x[1], x[2]), face);
    }
    comm.sum_in_place(count);
    std::size_t next = 0;
    std::erase_if(pairs, [&](const auto&) { return !(count[next++] > 0.5); });
  }
  if (pairs.empty()) return {};
  const auto in_contact = bodies_in_contact(now, sides(), comm);
  std::vector<Interpenetration> result;
  for (const auto& [a, b] : pairs) {
    if (in_contact.contains({a, b})) continue;
    Interpenetration deepest{a, b, 0, Point::Zero()};
    for (int axis = 0; axis < axes; ++axis) {
      const auto place = place_of(a, axis);
      const Point x(place->now[0], place->now[1], place->now[2]);
      double nearest = std::numeric_limits<double>::infinity();
      for (const auto& face : faces[b])
        closest_points(x, face, [&](const ClosestPoint& found) { nearest = std::min(nearest, found.distance); });
      nearest = comm.min(nearest);
      if (nearest > deepest.depth) deepest = {a, b, nearest, Point(place->before[0], place->before[1], place->before[2])};
    }
    result.push_back(deepest);
  }
  return result;
}

}  // namespace mortise::contact
