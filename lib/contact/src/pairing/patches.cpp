#include "pairing/patches.hpp"

#include <algorithm>
#include <array>
#include <tuple>

namespace mortise::contact {

namespace {

// Whether a face lies near enough to another body that its patch may need it.
bool near_body(int face, int other, const Ground& ground)
{
  const auto& skin = ground.skin;
  const auto& lengths = ground.lengths;
  const auto& [faces, largest, tree] = ground.of_body.at(other);
  const int body = skin.body[at(face)];
  const auto near = tree.candidates(grown(skin.box[at(face)], lengths.margin(skin.size[at(face)], body, largest, other)));
  return std::any_of(near.begin(), near.end(), [&](int i) {
    const int f = faces[at(i)];
    return grown(skin.box[at(face)], lengths.margin(skin.size[at(face)], body, skin.size[at(f)], other))
        .intersects(skin.box[at(f)]);
  });
}

// Whether a face meets another body only through one of the two: the far side of a thin body, which its patch must not reach.
bool is_far_side(int face, int other, double reach, const Ground& ground)
{
  const auto& skin = ground.skin;
  for (Local i = skin.side.first_facet[at(face)]; i < skin.side.first_facet[at(face) + 1]; ++i) {
    const auto crossings = cross_skin(skin.facet[at(i)].centre(), skin.facet_normal[at(i)], reach, face, skin, ground.facets);
    bool meets = false, sees = false;
    for (const auto& c : crossings) {
      if (!c.entered || skin.body[at(c.face)] != other) continue;
      meets = true;
      sees = sees || in_sight(c, face, crossings, skin);
    }
    if (meets && !sees) return true;
  }
  return false;
}

int root_of(std::map<int, int>& parent, int face)
{
  while (parent.at(face) != face) face = parent.at(face) = parent.at(parent.at(face));
  return face;
}

}  // namespace

std::vector<std::vector<int>> smooth_neighbours(const Skin& skin)
{
  struct Edge {
    std::array<Local, 2> nodes;
    int face;
  };
  std::vector<Edge> edges;
  const auto& faces = skin.side.faces;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const auto corners = at(mesh::corner_count(faces.type[f]));
    for (std::size_t k = 0; k < corners; ++k) {
      const Local a = faces[f][k], b = corners == 2 ? -1 : faces[f][(k + 1) % corners];
      edges.push_back({{std::min(a, b), std::max(a, b)}, static_cast<int>(f)});
    }
  }
  std::sort(edges.begin(), edges.end(),
            [](const Edge& a, const Edge& b) { return std::tie(a.nodes, a.face) < std::tie(b.nodes, b.face); });
  std::vector<std::vector<int>> result(faces.size());
  for (std::size_t i = 0; i < edges.size(); ++i)
    for (std::size_t j = i + 1; j < edges.size() && edges[j].nodes == edges[i].nodes; ++j) {
      const int a = edges[i].face, b = edges[j].face;
      if (skin.normal[at(a)].dot(skin.normal[at(b)]) < kink) continue;
      result[at(a)].push_back(b);
      result[at(b)].push_back(a);
    }
  return result;
}

double reach_of(const std::vector<Facing>& facing, const Ground& ground)
{
  const auto& skin = ground.skin;
  const auto& lengths = ground.lengths;
  double largest = 0, widest = 0;
  for (const auto& f : facing) {
    const double a = skin.size[at(f.face)], b = skin.size[at(f.other)];
    largest = std::max({largest, a, b});
    widest = std::max({widest, lengths.window(a, b).second, -lengths.window(a, b).first});
  }
  if (lengths.bonded) return widest;
  return lengths.reach(largest, skin.body[at(facing.front().face)], skin.body[at(facing.front().other)]);
}

void grow_patches(int pair, const Bodies& bodies, const std::vector<Facing>& facing, const Ground& ground,
                  std::vector<Member>& members)
{
  const auto& skin = ground.skin;
  const double reach = reach_of(facing, ground);
  std::map<int, int> parent;
  std::vector<int> open;
  for (const auto& f : facing)
    for (const int face : {f.face, f.other})
      if (parent.emplace(face, face).second) open.push_back(face);
  std::set<int> refused;
  while (!open.empty()) {
    const int face = open.back();
    open.pop_back();
    for (const int next : ground.neighbours[at(face)]) {
      if (parent.contains(next) || refused.contains(next)) continue;
      const int other = skin.body[at(next)] == bodies.first ? bodies.second : bodies.first;
      if (!near_body(next, other, ground) || is_far_side(next, other, reach, ground)) {
        refused.insert(next);
        continue;
      }
      parent.emplace(next, next);
      open.push_back(next);
    }
  }
  const auto join = [&](int a, int b) {
    const int x = root_of(parent, a), y = root_of(parent, b);
    parent.at(std::max(x, y)) = std::min(x, y);
  };
  for (const auto& [face, at_first] : parent)
    for (const int next : ground.neighbours[at(face)])
      if (parent.contains(next)) join(face, next);
  for (const auto& f : facing) join(f.face, f.other);
  std::map<int, int> patch;
  for (const auto& [face, above] : parent) {
    const int number = patch.emplace(root_of(parent, face), static_cast<int>(patch.size())).first->second;
    members.push_back({pair, number, face});
  }
}

}  // namespace mortise::contact
