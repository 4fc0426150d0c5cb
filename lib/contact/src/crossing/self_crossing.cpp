#include "contact/self_crossing.hpp"

#include <algorithm>
#include <deque>
#include <set>
#include <tuple>

#include "contact/doubled_faces.hpp"
#include "crossing/near_itself.hpp"
#include "crossing/skin_edges.hpp"
#include "pairing/facing.hpp"
#include "search/boxes.hpp"
#include "surface/closest_point.hpp"

namespace mortise::contact {

namespace {

// Facets that fit cross by less than this many times what their smooth surfaces stand out of them.
constexpr double of_both_bulges = 1.5;

// A place of a body's surface, now and before, and the facets that have it.
struct MovedPlace {
  Point now, before;
  std::vector<std::size_t> facets;
};

// An edge that passes through facets of its body, which it came from in front of: where, from 0 to 1, and the faces of both.
struct SelfPassage {
  std::size_t edge;
  std::vector<double> at;
  std::set<std::pair<Global, Global>> faces;
};

// Facets of bodies as they are and as they were.
class MovedSkin {
 public:
  MovedSkin(const Skin& skin, const std::vector<Point>& before)
      : edges(edges_of(skin)), skin_(skin), before_(before), tree_(tree_of(skin.facet))
  {
    const auto& facets = skin.side.facets;
    for (std::size_t i = 0; i < facets.size(); ++i) {
      FaceGeometry facet{facets.type[i], {}};
      for (const Local n : facets[i]) facet.nodes.push_back(before[at(n)]);
      normal_before_.push_back(facet.normal());
      facet_before_.push_back(facet);
    }
    bulge_ = bulges_of(edges, skin.facet, skin.facet_normal);
  }

  const std::vector<SkinEdge> edges;

  MovedPlace node(Local n, std::vector<std::size_t> facets) const
  {
    return {skin_.side.points[at(n)], before_[at(n)], std::move(facets)};
  }

  MovedPlace on_edge(const SkinEdge& edge, double part) const
  {
    const auto between = [&](const std::vector<Point>& points) -> Point {
      return points[at(edge.nodes[0])] + part * (points[at(edge.nodes[1])] - points[at(edge.nodes[0])]);
    };
    return {between(skin_.side.points), between(before_), edge.facets};
  }

  MovedPlace middle(std::size_t facet) const { return {skin_.facet[facet].centre(), facet_before_[facet].centre(), {facet}}; }

  // All edges that have passed through facets of their body.
  std::vector<SelfPassage> passages()
  {
    std::vector<SelfPassage> result;
    std::vector<double> parts, parts_before;
    for (std::size_t e = 0; e < edges.size(); ++e) {
      const auto& edge = edges[e];
      const auto &points = skin_.side.points, &ends = before_;
      const Point &a = points[at(edge.nodes[0])], &b = points[at(edge.nodes[1])];
      Box box(a, a);
      box.extend(b);
      tree_.candidates(box, found_);
      SelfPassage passage{e, {}, {}};
      for (const int candidate : found_) {
        const std::size_t g = at(candidate);
        if (body_of(g) != edge.body || neighbours(edge.facets, g)) continue;
        parts.clear(), parts_before.clear();
        add_passages(a, b, skin_.facet[g], parts);
        if (parts.empty()) continue;
        add_passages(ends[at(edge.nodes[0])], ends[at(edge.nodes[1])], facet_before_[g], parts_before);
        if (!parts_before.empty()) continue;
        passage.at.insert(passage.at.end(), parts.begin(), parts.end());
        const auto place = on_edge(edge, parts.front());
        if (!faces_another(edge.facets, g) || !was_in_front(place, place.now, g)) continue;
        for (const std::size_t own : edge.facets) passage.faces.emplace(face_id(own), face_id(g));
      }
      if (!passage.faces.empty()) result.push_back(std::move(passage));
    }
    return result;
  }

  struct Depth {
    double depth = 0;         // 0: outside, or farther from the surface than asked
    double bulge = 0;         // of the facets there and here
    std::vector<int> facets;  // at the nearest place
  };

  // How far a place has moved into its own body, up to `largest`: from the nearest place of the facets that it was in front of.
  Depth depth(const MovedPlace& x, double largest)
  {
    const auto first = x.facets.front();
    ClosestPoint best{x.now, std::numeric_limits<double>::infinity(), Point::Zero()};
    std::size_t nearest = first;
    for (double reach = std::min(skin_.facet[first].size(), largest);; reach = farther(reach, largest)) {
      tree_.candidates(Box(x.now - Point::Constant(reach), x.now + Point::Constant(reach)), found_);
      for (const int candidate : found_) {
        const std::size_t g = at(candidate);
        if (body_of(g) != body_of(first) || neighbours(x.facets, g)) continue;
        closest_points(x.now, skin_.facet[g], [&](const ClosestPoint& place) {
          if (!(place.distance < best.distance) || place.distance > reach || !was_in_front(x, place.at, g)) return;
          best = place;
          nearest = g;
        });
      }
      if (best.distance <= reach || reach >= largest) break;
    }
    if (!(best.distance <= largest)) return {};
    const Point moved = x.now - x.before - (best.at - before_of(nearest, best.at));
    if (best.distance > (1 + rounding) * moved.norm()) return {};
    Depth result{best.distance, 0, {}};
    const Point normal = normal_at(best.at, nearest, result);
    if (!(normal.dot(x.now - best.at) < 0)) return {};
    double own = 0;
    for (const std::size_t f : x.facets) own = std::max(own, bulge_[f]);
    result.bulge += own;
    return result;
  }

  Global face_id(std::size_t facet) const { return skin_.face_id[face_of(facet)]; }

 private:
  std::size_t face_of(std::size_t facet) const { return at(skin_.side.face_of[facet]); }
  int body_of(std::size_t facet) const { return skin_.body[face_of(facet)]; }

  // Whether the faces of some facets, and that of g, have a node in common.
  bool neighbours(const std::vector<std::size_t>& own, std::size_t g) const
  {
    const auto others = skin_.side.faces[face_of(g)];
    return std::any_of(own.begin(), own.end(), [&](std::size_t f) {
      const auto nodes = skin_.side.faces[face_of(f)];
      return std::find_first_of(nodes.begin(), nodes.end(), others.begin(), others.end()) != nodes.end();
    });
  }

  // Whether one of the facets looked at g, by its normal.
  bool faces_another(const std::vector<std::size_t>& own, std::size_t g) const
  {
    return std::any_of(own.begin(), own.end(), [&](std::size_t f) { return normal_before_[f].dot(normal_before_[g]) < opposed; });
  }

  // Whether x was in front of the place of facet g that is at `now`, or lay on it and looked at it.
  bool was_in_front(const MovedPlace& x, const Point& now, std::size_t g) const
  {
    const double height = normal_before_[g].dot(x.before - before_of(g, now)), none = rounding * facet_before_[g].size();
    return height > none || (height >= -none && faces_another(x.facets, g));
  }

  // Where the place of a facet was that is at x now.
  Point before_of(std::size_t facet, const Point& x) const
  {
    const auto &n = skin_.facet[facet].nodes, &b = facet_before_[facet].nodes;
    if (n.size() == 2) {
      const double square = (n[1] - n[0]).squaredNorm();
      return b[0] + (square > 0 ? std::clamp((x - n[0]).dot(n[1] - n[0]) / square, 0.0, 1.0) : 0.0) * (b[1] - b[0]);
    }
    Point result = b[0];
    double inside = -std::numeric_limits<double>::infinity();
    const auto triangle = [&](std::size_t j, std::size_t k) {
      const Point first = n[j] - n[0], second = n[k] - n[0], across = first.cross(second);
      const double square = across.squaredNorm();
      if (!(square > 0)) return;
      const double u = (x - n[0]).cross(second).dot(across) / square, v = first.cross(x - n[0]).dot(across) / square;
      const double least = std::min({u, v, 1 - u - v});
      if (!(least > inside)) return;
      inside = least;
      result = b[0] + u * (b[j] - b[0]) + v * (b[k] - b[0]);
    };
    triangle(1, 2);
    if (n.size() == 4) triangle(2, 3);
    return result;
  }

  // The mean normal of the facets of the body that meet at a place of `facet`.
  Point normal_at(const Point& x, std::size_t facet, Depth& result)
  {
    const double near = rounding * skin_.facet[facet].size();
    Point normal = Point::Zero();
    tree_.candidates(Box(x - Point::Constant(near), x + Point::Constant(near)), found_);
    for (const int candidate : found_) {
      const std::size_t g = at(candidate);
      if (g != facet && (body_of(g) != body_of(facet) || !neighbours({facet}, g))) continue;
      closest_points(x, skin_.facet[g], [&](const ClosestPoint& place) {
        if (place.distance > near) return;
        normal += place.normal;
        result.bulge = std::max(result.bulge, bulge_[g]);
        result.facets.push_back(candidate);
      });
    }
    return normal;
  }

  const Skin& skin_;
  const std::vector<Point>& before_;
  Tree tree_;
  std::vector<FaceGeometry> facet_before_;
  std::vector<Point> normal_before_;
  std::vector<double> bulge_;
  std::vector<int> found_;  // for the place at work
};

// Two faces that are to be left out: the sides of a contact, or of a seam.
class LeftOut {
 public:
  LeftOut(ContactSides sides, const std::vector<DoubledFaces>& doubled) : sides_(std::move(sides))
  {
    for (const auto& two : doubled) seam_.insert(two.faces.begin(), two.faces.end());
  }

  bool both(Global face, Global other) const
  {
    return sides_.opposite(face, other) || (seam_.contains(face) && seam_.contains(other));
  }

 private:
  ContactSides sides_;
  std::set<Global> seam_;
};

// Of each body the longest displacement of its nodes against their mean.
std::map<int, double> longest_within_bodies(const Skin& skin, const std::vector<Point>& before)
{
  std::map<int, std::set<Local>> nodes;
  for (std::size_t f = 0; f < skin.count(); ++f) nodes[skin.body[f]].insert(skin.side.faces[f].begin(), skin.side.faces[f].end());
  std::map<int, double> result;
  for (const auto& [body, some] : nodes) {
    Point mean = Point::Zero();
    for (const Local n : some) mean += (skin.side.points[at(n)] - before[at(n)]) / static_cast<double>(some.size());
    for (const Local n : some) result[body] = std::max(result[body], (skin.side.points[at(n)] - before[at(n)] - mean).norm());
  }
  return result;
}

// What has moved into its own body, from the faces that cross on over nodes that have.
std::vector<Interpenetration> deep_in_themselves(const Skin& skin, MovedSkin& moved, const std::vector<SelfPassage>& passages,
                                                 const std::map<int, double>& longest, const LeftOut& left_out, double least)
{
  const auto& side = skin.side;
  std::vector<std::vector<std::size_t>> facets_at(side.points.size());
  for (std::size_t i = 0; i < side.facets.size(); ++i)
    for (const Local n : side.facets[i]) facets_at[at(n)].push_back(i);
  std::vector<Interpenetration> result;
  const auto deep = [&](const MovedPlace& place) {
    const int body = skin.body[at(side.face_of[place.facets.front()])];
    const auto found = moved.depth(place, 2 * longest.at(body));
    if (!(found.depth > 0)) return false;
    for (const std::size_t own : place.facets)
      for (const int other : found.facets)
        if (left_out.both(moved.face_id(own), moved.face_id(at(other)))) return false;
    if (found.depth > least * longest.at(body) && found.depth > of_both_bulges * found.bulge)
      result.push_back({body, body, found.depth, place.before});
    return true;
  };
  std::deque<std::size_t> waiting;  // faces
  std::vector<char> seen(skin.count(), 0), looked_at(side.points.size(), 0);
  const auto add = [&](std::size_t face) {
    if (!std::exchange(seen[face], 1)) waiting.push_back(face);
  };
  for (auto [edge, parts, faces] : passages) {
    for (const auto& [own, other] : faces)
      for (const Global face : {own, other})
        add(static_cast<std::size_t>(std::lower_bound(skin.face_id.begin(), skin.face_id.end(), face) - skin.face_id.begin()));
    std::sort(parts.begin(), parts.end());
    for (std::size_t i = 1; i < parts.size(); ++i)
      if (parts[i] - parts[i - 1] > rounding) deep(moved.on_edge(moved.edges[edge], (parts[i] + parts[i - 1]) / 2));
  }
  for (; !waiting.empty(); waiting.pop_front()) {
    const std::size_t face = waiting.front();
    for (auto facet = at(side.first_facet[face]); facet < at(side.first_facet[face + 1]); ++facet) deep(moved.middle(facet));
    for (const Local n : side.faces[face])
      if (!std::exchange(looked_at[at(n)], 1) && !facets_at[at(n)].empty() && deep(moved.node(n, facets_at[at(n)])))
        for (const std::size_t facet : facets_at[at(n)]) add(at(side.face_of[facet]));
  }
  return result;
}

// The skin of these faces, and its points before.
struct GatheredSkin {
  Skin skin;
  std::vector<Point> before;
};

// Collective.
GatheredSkin gather_both(const mesh::Surface& before, const mesh::Surface& now, const std::vector<std::size_t>& chosen,
                         fem::Kinematics kinematics, const Communicator& comm)
{
  return {gather_skin(part_of(now, chosen), kinematics, comm), gather_points(part_of(before, chosen), comm)};
}

}  // namespace

std::vector<Interpenetration> find_self_crossings(const mesh::Surface& before, const mesh::Surface& now,
                                                  const std::function<ContactSides()>& sides, double least,
                                                  fem::Kinematics kinematics, const Communicator& comm)
{
  const auto chosen = near_itself(before, now, kinematics, comm);
  if (!comm.any(!chosen.empty())) return {};
  std::set<int> bodies;
  {
    const auto near = gather_both(before, now, chosen, kinematics, comm);
    MovedSkin moved(near.skin, near.before);
    const auto passages = moved.passages();
    for (const auto& passage : passages) bodies.insert(moved.edges[passage.edge].body);
  }
  if (bodies.empty()) return {};
  const LeftOut left_out(sides(), find_doubled_faces(before, kinematics, comm));
  std::vector<std::size_t> whole;
  for (std::size_t f = 0; f < now.body.size(); ++f)
    if (bodies.contains(now.body[f])) whole.push_back(f);
  const auto near = gather_both(before, now, whole, kinematics, comm);
  MovedSkin moved(near.skin, near.before);
  auto passages = moved.passages();
  for (auto& passage : passages)
    std::erase_if(passage.faces, [&](const auto& two) { return left_out.both(two.first, two.second); });
  std::erase_if(passages, [](const SelfPassage& passage) { return passage.faces.empty(); });
  if (passages.empty()) return {};
  const auto longest = longest_within_bodies(near.skin, near.before);
  auto result = deep_in_themselves(near.skin, moved, passages, longest, left_out, least);
  std::stable_sort(result.begin(), result.end(), [](const auto& a, const auto& b) {
    return std::tuple(a.body, a.at[0], a.at[1], a.at[2]) < std::tuple(b.body, b.at[0], b.at[1], b.at[2]);
  });
  return result;
}

}  // namespace mortise::contact
