#include "contact/interpenetration.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <tuple>

#include "closest_place.hpp"
#include "facing.hpp"
#include "near.hpp"
#include "skin.hpp"

namespace mortise::contact {

namespace {

// A facet continues the surface of the other body if their normals enclose less than 25 degrees, by their cosine, and the place
// lies in the facet's plane or a little below it, in parts of its size. What lies above is outside: a coating is not in its plate.
constexpr double continued = 0.9, below = 0.1;
// Parts of a face's size. Facets of bodies that fit cross by less than the first, those of a circle of eight facets by a tenth. As
// far as the second at least the way out is looked for.
constexpr double of_facets = 0.25, looked_for = 0.5;

// Facets at some points in space, by bodies.
class Surfaces {
 public:
  Surfaces(const Skin& skin, const std::vector<Point>& points) : skin_(skin)
  {
    const auto& side = skin.side;
    std::map<int, std::vector<FaceGeometry>> of_body;
    for (std::size_t i = 0; i < side.facets.size(); ++i) {
      FaceGeometry facet{side.facets.type[i], {}};
      for (const Local n : side.facets[i]) facet.nodes.push_back(points[at(n)]);
      normal_.push_back(facet.normal());
      auto& body = bodies_[skin.body[at(side.face_of[i])]];
      body.facets.push_back(i);
      for (const auto& x : facet.nodes) body.box.extend(x);
      of_body[skin.body[at(side.face_of[i])]].push_back(facet);
      facet_.push_back(facet);
    }
    for (auto& [body, facets] : of_body) bodies_.at(body).tree.emplace_back(tree_of(facets));
  }

  // Of the largest facet of `own`.
  double size_of(const std::vector<std::size_t>& own) const
  {
    double size = 0;
    for (const std::size_t f : own) size = std::max(size, facet_[f].size());
    return size;
  }

  // Bodies whose facets, or what lies behind them by up to `depth`, may reach a point.
  std::vector<int> near(const Point& x, double depth) const
  {
    std::vector<int> result;
    for (const auto& [number, body] : bodies_)
      if (grown(body.box, depth).contains(x)) result.push_back(number);
    return result;
  }

  struct Depth {
    double depth = 0;        // 0: outside, or farther from the surface than asked
    double size = 0;         // of the smaller face, here or there
    std::vector<int> faces;  // at the nearest place
  };

  // How deep x is in a body, up to `range.largest`. `own`: the facets of its own body that meet there.
  Depth depth(const Point& x, const std::vector<std::size_t>& own, int number, const DepthRange& range) const
  {
    const auto& body = bodies_.at(number);
    const double size = size_of(own);
    std::vector<int> found;
    std::vector<std::pair<ClosestPlace, std::size_t>> places;  // with the facet
    for (double reach = std::min(size, range.largest);; reach = std::min(4 * reach, range.largest)) {
      double nearest = reach;
      places.clear();
      found.clear();
      body.tree.front().candidates(Box(x - Point::Constant(reach), x + Point::Constant(reach)), found);
      for (const int f : found) {
        const std::size_t facet = body.facets[at(f)];
        if (goes_on(x, own, facet, range.least)) continue;
        closest_places(x, facet_[facet], [&](const ClosestPlace& place) {
          if (place.distance > nearest * (1 + rounding)) return;
          nearest = std::min(nearest, place.distance);
          places.emplace_back(place, facet);
        });
      }
      if (!places.empty() || reach >= range.largest) break;
    }
    if (places.empty()) return {};
    const auto& best = std::min_element(places.begin(), places.end(), [](const auto& a, const auto& b) {
                         return a.first.distance < b.first.distance;
                       })->first;
    Depth result{0, size, {}};
    Point normal = Point::Zero();
    for (const auto& [place, facet] : places) {
      if ((place.at - best.at).norm() > rounding * facet_[facet].size()) continue;
      normal += place.normal;
      result.size = std::min(result.size, facet_[facet].size());
      result.faces.push_back(skin_.side.face_of[facet]);
    }
    if (normal.dot(x - best.at) < 0) result.depth = best.distance;
    return result;
  }

 private:
  // Whether a facet continues the surface of the body that x is of, whose facets there are `own`.
  bool goes_on(const Point& x, const std::vector<std::size_t>& own, std::size_t facet, double least) const
  {
    const double height = normal_[facet].dot(x - facet_[facet].nodes[0]), size = facet_[facet].size();
    return height <= rounding * size && -height <= std::max(least, below * size) &&
           std::any_of(own.begin(), own.end(), [&](std::size_t f) { return normal_[f].dot(normal_[facet]) > continued; });
  }

  struct OfBody {
    std::vector<std::size_t> facets;
    std::vector<Tree> tree;  // one
    Box box;
  };
  const Skin& skin_;
  std::vector<FaceGeometry> facet_;
  std::vector<Point> normal_;
  std::map<int, OfBody> bodies_;
};

// A node, or the middle of a facet, and the facets that meet there.
struct PlaceOfSkin {
  int node;  // -1: the middle of its facet
  std::vector<std::size_t> facets;

  Point at_points(const Side& side, const std::vector<Point>& points) const
  {
    if (node >= 0) return points[at(node)];
    Point sum = Point::Zero();
    const auto nodes = side.facets[facets.front()];
    for (const Local n : nodes) sum += points[at(n)];
    return sum / static_cast<double>(nodes.size());
  }
};

// A place in another body.
struct Deep {
  std::size_t place;
  int body, other;
  double depth;
  bool by_facets;  // may be the facets' doing alone
  std::vector<int> faces;  // of the other body, next to the place
};

// Interpenetration, as plain bytes.
struct SentPlace {
  int body, other;
  double depth;
  std::array<double, 3> at;
};

// The faces of `all` that are in `some`, whose faces come in the same order.
mesh::Surface same_faces(const mesh::Surface& all, const mesh::Surface& some)
{
  std::vector<std::size_t> chosen;
  for (std::size_t f = 0; f < all.faces.size() && chosen.size() < some.face_id.size(); ++f)
    if (all.face_id[f] == some.face_id[chosen.size()]) chosen.push_back(f);
  return part_of(all, chosen);
}

// This rank's share of nodes and middles of facets.
std::vector<PlaceOfSkin> places_of(const Side& side, const Communicator& comm)
{
  const auto ranks = static_cast<std::size_t>(comm.size()), rank = static_cast<std::size_t>(comm.rank());
  std::vector<PlaceOfSkin> places;
  std::vector<std::size_t> place_of(side.points.size(), side.points.size());
  for (std::size_t n = rank; n < side.points.size(); n += ranks) {
    place_of[n] = places.size();
    places.push_back({static_cast<int>(n), {}});
  }
  for (std::size_t i = 0; i < side.facets.size(); ++i) {
    for (const Local n : side.facets[i])
      if (place_of[at(n)] < side.points.size()) places[place_of[at(n)]].facets.push_back(i);
    if (i % ranks == rank) places.push_back({-1, {i}});
  }
  return places;
}

bool in_contact(const Skin& skin, const std::vector<std::size_t>& facets, const std::vector<int>& others,
                const ContactSides& sides)
{
  return std::any_of(facets.begin(), facets.end(), [&](std::size_t facet) {
    return std::any_of(others.begin(), others.end(), [&](int other) {
      return sides.opposite(skin.face_id[at(skin.side.face_of[facet])], skin.face_id[at(other)]);
    });
  });
}

// What of this rank's places lies deeper than `least` in other bodies, at these points.
std::vector<Deep> deep_places(const Skin& skin, const std::vector<Point>& points, const std::vector<PlaceOfSkin>& places,
                              const DepthRange& range)
{
  const Surfaces surfaces(skin, points);
  std::vector<Deep> deep;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto& facets = places[i].facets;
    const int own = skin.body[at(skin.side.face_of[facets.front()])];
    const Point x = places[i].at_points(skin.side, points);
    const DepthRange here{range.least, std::max(range.largest, looked_for * surfaces.size_of(facets))};
    for (const int other : surfaces.near(x, here.largest)) {
      if (other == own) continue;
      auto found = surfaces.depth(x, facets, other, here);
      if (found.depth > range.least)
        deep.push_back({i, own, other, found.depth, found.depth <= of_facets * found.size, std::move(found.faces)});
    }
  }
  return deep;
}

// Of each two bodies what may be the facets' doing, over all ranks. Collective.
std::map<std::pair<int, int>, double> deepest_facets(const std::vector<Deep>& places, const Communicator& comm)
{
  std::vector<SentPlace> sent;
  for (const auto& d : places)
    if (d.by_facets) sent.push_back({d.body, d.other, d.depth, {}});
  std::map<std::pair<int, int>, double> deepest;
  for (const auto& d : comm.all_gather(sent)) {
    double& depth = deepest[std::minmax(d.body, d.other)];
    depth = std::max(depth, d.depth);
  }
  return deepest;
}

}  // namespace

bool ContactSides::opposite(Global face, Global other) const
{
  const auto a = of_face.find(face), b = of_face.find(other);
  return a != of_face.end() && b != of_face.end() && std::any_of(a->second.begin(), a->second.end(), [&](int side) {
           return std::find(b->second.begin(), b->second.end(), side ^ 1) != b->second.end();
         });
}

std::vector<Interpenetration> find_interpenetrations(const mesh::Surface& before, const mesh::Surface& now, int bodies,
                                                     const std::function<ContactSides()>& sides, const DepthRange& range,
                                                     fem::Kinematics kinematics, const Communicator& comm)
{
  const Lengths lengths{range.largest, 0, false, diagonals(now, bodies, comm)};
  const auto near = near_others(now, lengths, comm);
  const Skin skin = gather_skin(near, kinematics, comm);
  const auto places = places_of(skin.side, comm);
  auto deep = deep_places(skin, skin.side.points, places, range);
  if (!comm.any(!deep.empty())) return {};
  const auto known = sides();
  const auto drop_contacts = [&](std::vector<Deep>& some) {
    std::erase_if(some, [&](const Deep& d) { return in_contact(skin, places[d.place].facets, d.faces, known); });
  };
  drop_contacts(deep);
  if (!comm.any(!deep.empty())) return {};
  // Facets of bodies that fit cross before anything moves.
  const auto points = gather(same_faces(before, near), kinematics, comm).points;
  auto deep_before = deep_places(skin, points, places, {range.least, 2 * range.largest});
  drop_contacts(deep_before);
  const auto deepest = deepest_facets(deep_before, comm);
  std::vector<SentPlace> deeper;
  for (const auto& d : deep) {
    const auto found = deepest.find(std::minmax(d.body, d.other));
    const Point x = places[d.place].at_points(skin.side, points);
    if (found == deepest.end() || d.depth - found->second > range.least)
      deeper.push_back({d.body, d.other, d.depth, {x[0], x[1], x[2]}});
  }
  deeper = comm.all_gather(deeper);
  std::sort(deeper.begin(), deeper.end(), [](const SentPlace& a, const SentPlace& b) {
    return std::tie(a.body, a.other, a.at) < std::tie(b.body, b.other, b.at);
  });
  std::vector<Interpenetration> result;
  for (const auto& [own, other, depth, x] : deeper) result.push_back({own, other, depth, Point(x[0], x[1], x[2])});
  return result;
}

}  // namespace mortise::contact
