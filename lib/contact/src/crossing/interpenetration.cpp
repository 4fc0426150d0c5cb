#include "contact/interpenetration.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <tuple>

#include "crossing/near_skin.hpp"
#include "crossing/skin_edges.hpp"
#include "pairing/facing.hpp"
#include "surface/closest_point.hpp"

namespace mortise::contact {

namespace {

// A facet continues the surface of the other body if their normals enclose less than 25 degrees, by their cosine, and the place
// lies in the facet's plane, or below it by no more than facets that fit cross. What lies above is outside: a coating is not in
// its plate.
constexpr double continued = 0.9;
// Facets of bodies that fit cross by less than this many times what their smooth surfaces stand out of them, or this part of a
// face's size.
constexpr double of_bulges = 1.5, of_face = 0.01;
// Part of a face's size as far as which at least the way out is looked for.
constexpr double looked_for = 0.5;
// Facets whose planes enclose less than 25 degrees, by the cosine, are along each other.
constexpr double along_each_other = 0.9;

// By how much facets that fit may cross. `size`: of the smaller one.
double fit(double size, double bulge, double other)
{
  return std::max(of_face * size, of_bulges * (bulge + other));
}

// Facets at some points in space, by bodies.
class Surfaces {
 public:
  Surfaces(const Skin& skin, const std::vector<SkinEdge>& edges, const std::vector<Point>& points) : skin_(skin)
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
    bulge_ = bulges_of(edges, facet_, normal_);
    std::vector<Box> boxes;
    for (const auto& body : bodies_) {
      boxes.push_back(body.second.box);
      boxed_.push_back(&body);
    }
    box_tree_.emplace_back(std::move(boxes));
  }

  // Of the largest facet of `own`.
  double size_of(const std::vector<std::size_t>& own) const
  {
    double size = 0;
    for (const std::size_t f : own) size = std::max(size, facet_[f].size());
    return size;
  }

  // Of the facet of `own` that has the largest.
  double bulge_of(const std::vector<std::size_t>& own) const
  {
    double bulge = 0;
    for (const std::size_t f : own) bulge = std::max(bulge, bulge_[f]);
    return bulge;
  }

  // Calls use(t) for the middle of each part of an edge, from 0 to 1, between two passages through facets of another body that
  // are not along its own.
  template <class Use>
  void each_part_between(const SkinEdge& edge, const Point& a, const Point& b, const Use& use)
  {
    Box box(a, a);
    box.extend(b);
    for (const int near : box_tree_.front().candidates(box)) {
      const auto& [number, body] = *boxed_[at(near)];
      if (number == edge.body) continue;
      body.tree.front().candidates(box, found_);
      passages_.clear();
      for (const int f : found_) {
        const std::size_t facet = body.facets[at(f)];
        if (std::any_of(edge.facets.begin(), edge.facets.end(),
                        [&](std::size_t own) { return std::abs(normal_[own].dot(normal_[facet])) < along_each_other; }))
          add_passages(a, b, facet_[facet], passages_);
      }
      std::sort(passages_.begin(), passages_.end());
      for (std::size_t i = 1; i < passages_.size(); ++i)
        if (passages_[i] - passages_[i - 1] > rounding) use((passages_[i] + passages_[i - 1]) / 2);
    }
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
    double bulge = 0;        // at the nearest place
    std::vector<int> faces;  // at the nearest place
  };

  // How deep x is in a body, up to `range.largest`. `own`: the facets of its own body that meet there.
  Depth depth(const Point& x, const std::vector<std::size_t>& own, int number, const DepthRange& range) const
  {
    const auto& body = bodies_.at(number);
    const double size = size_of(own);
    std::vector<int> found;
    std::vector<std::pair<ClosestPoint, std::size_t>> places;  // with the facet
    for (double reach = std::min(size, range.largest);; reach = farther(reach, range.largest)) {
      double nearest = reach;
      places.clear();
      found.clear();
      body.tree.front().candidates(Box(x - Point::Constant(reach), x + Point::Constant(reach)), found);
      for (const int f : found) {
        const std::size_t facet = body.facets[at(f)];
        if (goes_on(x, own, facet, range.least)) continue;
        closest_points(x, facet_[facet], [&](const ClosestPoint& place) {
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
    Depth result{0, size, 0, {}};
    Point normal = Point::Zero();
    for (const auto& [place, facet] : places) {
      if ((place.at - best.at).norm() > rounding * facet_[facet].size()) continue;
      normal += place.normal;
      result.size = std::min(result.size, facet_[facet].size());
      result.bulge = std::max(result.bulge, bulge_[facet]);
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
    return height <= rounding * size && -height <= std::max(least, fit(size, bulge_of(own), bulge_[facet])) &&
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
  std::vector<double> bulge_;
  std::map<int, OfBody> bodies_;
  std::vector<const std::pair<const int, OfBody>*> boxed_;
  std::vector<Tree> box_tree_;  // one, of these
  std::vector<int> found_;      // for the edge at work, as what follows
  std::vector<double> passages_;
};

// A node, a place on an edge, or the middle of a facet, and the facets that meet there.
struct PlaceOfSkin {
  int node;                 // -1: the middle of its facet, if the edge is none
  std::array<int, 2> edge;  // the nodes of an edge, or -1
  double part;              // of the way from its first node
  std::vector<std::size_t> facets;

  Point at_points(const Side& side, const std::vector<Point>& points) const
  {
    if (node >= 0) return points[at(node)];
    if (edge[0] >= 0) return points[at(edge[0])] + part * (points[at(edge[1])] - points[at(edge[0])]);
    Point sum = Point::Zero();
    const auto nodes = side.facets[facets.front()];
    for (const Local n : nodes) sum += points[at(n)];
    return sum / static_cast<double>(nodes.size());
  }
};

// A place in another body.
struct Deep {
  PlaceOfSkin place;
  int body, other;
  double depth;
  bool by_facets;          // may be the facets' doing alone
  std::vector<int> faces;  // of the other body, next to the place
};

// Interpenetration, as plain bytes.
struct SentPlace {
  int body, other;
  double depth;
  std::array<double, 3> at;
};

// Nodes and middles of facets of this rank's faces, those of the lowest rank that has a face there.
std::vector<PlaceOfSkin> places_of(const NearSkin& near, const Communicator& comm)
{
  const auto& side = near.skin().side;
  std::vector<int> lowest(side.points.size(), comm.size());
  for (std::size_t f = 0; f < side.faces.size(); ++f)
    for (const Local n : side.faces[f]) lowest[at(n)] = std::min(lowest[at(n)], near.rank()[f]);
  std::vector<PlaceOfSkin> places;
  std::vector<std::size_t> place_of(side.points.size(), side.points.size());
  for (std::size_t n = 0; n < side.points.size(); ++n) {
    if (lowest[n] != comm.rank()) continue;
    place_of[n] = places.size();
    places.push_back({static_cast<int>(n), {-1, -1}, 0, {}});
  }
  for (std::size_t i = 0; i < side.facets.size(); ++i) {
    for (const Local n : side.facets[i])
      if (place_of[at(n)] < side.points.size()) places[place_of[at(n)]].facets.push_back(i);
    if (near.rank_of_facet(i) == comm.rank()) places.push_back({-1, {-1, -1}, 0, {i}});
  }
  return places;
}

// What is known of contacts, by faces and bodies of a skin.
class Touching {
 public:
  // Collective.
  Touching(const Skin& skin, const ContactSides& sides, const Communicator& comm) : skin_(skin), sides_(sides)
  {
    std::set<std::array<int, 2>> found;  // sides, bodies
    for (std::size_t f = 0; f < skin.face_id.size(); ++f)
      for (const int side : sides_at(static_cast<int>(f))) found.insert({side, skin.body[f]});
    for (const auto& [side, body] : comm.all_gather(std::vector(found.begin(), found.end()))) bodies_[side].insert(body);
  }

  // Whether contacts keep a place apart from the other body: they have its faces and those next to it on their two sides, or,
  // where facets that fit cross, as those of a shaft and a hub round a thin sleeve, a third body on the other sides of both.
  bool keep_apart(const Deep& d) const
  {
    std::set<int> own, other;
    for (const std::size_t facet : d.place.facets) {
      const int face = skin_.side.face_of[facet];
      for (const int near : d.faces)
        if (sides_.opposite(skin_.face_id[at(face)], skin_.face_id[at(near)])) return true;
      add_partners(face, own);
    }
    for (const int near : d.faces) add_partners(near, other);
    return d.by_facets && std::any_of(own.begin(), own.end(),
                                      [&](int body) { return body != d.body && body != d.other && other.contains(body); });
  }

 private:
  const std::vector<int>& sides_at(int face) const
  {
    static const std::vector<int> none;
    const auto found = sides_.of_face.find(skin_.face_id[at(face)]);
    return found == sides_.of_face.end() ? none : found->second;
  }

  void add_partners(int face, std::set<int>& bodies) const
  {
    for (const int side : sides_at(face))
      if (const auto found = bodies_.find(side ^ 1); found != bodies_.end())
        bodies.insert(found->second.begin(), found->second.end());
  }

  const Skin& skin_;
  const ContactSides& sides_;
  std::map<int, std::set<int>> bodies_;  // of each side
};

// What of this rank's places, and of what passes through other bodies of its edges, lies deeper than `least` in other bodies, at
// these points.
std::vector<Deep> deep_places(const NearSkin& near, const std::vector<SkinEdge>& edges, const std::vector<Point>& points,
                              const std::vector<PlaceOfSkin>& places, const DepthRange& range, const Communicator& comm)
{
  const auto& skin = near.skin();
  Surfaces surfaces(skin, edges, points);
  std::vector<Deep> deep;
  const auto look = [&](const PlaceOfSkin& place) {
    const auto& facets = place.facets;
    const int own = skin.body[at(skin.side.face_of[facets.front()])];
    const Point x = place.at_points(skin.side, points);
    const DepthRange here{range.least, std::max(range.largest, looked_for * surfaces.size_of(facets))};
    for (const int other : surfaces.near(x, here.largest)) {
      if (other == own) continue;
      auto found = surfaces.depth(x, facets, other, here);
      if (!(found.depth > range.least)) continue;
      const bool by_facets = found.depth <= fit(found.size, surfaces.bulge_of(facets), found.bulge);
      deep.push_back({place, own, other, found.depth, by_facets, std::move(found.faces)});
    }
  };
  for (const auto& place : places) look(place);
  for (const auto& edge : edges) {
    int lowest = comm.size();
    for (const std::size_t facet : edge.facets) lowest = std::min(lowest, near.rank_of_facet(facet));
    if (lowest != comm.rank()) continue;
    surfaces.each_part_between(edge, points[at(edge.nodes[0])], points[at(edge.nodes[1])], [&](double part) {
      look({-1, {edge.nodes[0], edge.nodes[1]}, part, edge.facets});
    });
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
  // At the points before places look as far as 2 range.largest, and were nearer to each other by range.largest.
  const NearSkin near(now, bodies, lengths, 3 * range.largest, kinematics, comm);
  const auto& skin = near.skin();
  const auto edges = edges_of(skin);
  const auto places = places_of(near, comm);
  auto deep = deep_places(near, edges, skin.side.points, places, range, comm);
  if (!comm.any(!deep.empty())) return {};
  const auto known = sides();
  const Touching touching(skin, known, comm);
  const auto drop_contacts = [&](std::vector<Deep>& some) {
    std::erase_if(some, [&](const Deep& d) { return touching.keep_apart(d); });
  };
  drop_contacts(deep);
  if (!comm.any(!deep.empty())) return {};
  // Facets of bodies that fit cross before anything moves.
  const auto points = near.points_of(before, comm);
  auto deep_before = deep_places(near, edges, points, places, {range.least, 2 * range.largest}, comm);
  drop_contacts(deep_before);
  const auto deepest = deepest_facets(deep_before, comm);
  std::vector<SentPlace> deeper;
  for (const auto& d : deep) {
    const auto found = deepest.find(std::minmax(d.body, d.other));
    const Point x = d.place.at_points(skin.side, points);
    if (!d.by_facets || found == deepest.end() || d.depth - found->second > range.least)
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
