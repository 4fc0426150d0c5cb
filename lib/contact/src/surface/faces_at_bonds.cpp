#include "surface/faces_at_bonds.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <tuple>

#include "contact/cyclic.hpp"
#include "pairing/skin.hpp"
#include "rows/by_node.hpp"
#include "search/tree.hpp"
#include "surface/curved_borders.hpp"
#include "surface/kinks.hpp"

namespace mortise::contact {

namespace {

constexpr double same_node_across = 1e-3;  // of the shortest edge there

}  // namespace

FacesAtBonds::FacesAtBonds(std::span<const Pair> pairs, fem::Kinematics kinematics, const Communicator& comm)
{
  const auto bonded = [](const Pair& pair) { return pair.options.law == Law::bonded; };
  const auto is_bond = [&](const Pair& pair) { return bonded(pair) && !pair.options.preload && pair.primary; };
  if (std::ranges::none_of(pairs, is_bond) || std::ranges::all_of(pairs, bonded)) return;
  std::vector<BondNode> marked;
  std::vector<const mesh::Surface*> surfaces;
  for (std::size_t c = 0; c < pairs.size(); ++c) {
    const auto& pair = pairs[c];
    if (is_bond(pair)) {
      for (const Global node : pair.secondary.node_id) marked.push_back({node, static_cast<int>(c), 1});
      for (const Global node : pair.primary->node_id) marked.push_back({node, static_cast<int>(c), 0});
    }
    if (bonded(pair)) continue;
    surfaces.push_back(&pair.secondary);
    if (pair.primary && !pair.options.cyclic) surfaces.push_back(pair.primary.get());
  }
  std::ranges::sort(surfaces);
  surfaces.erase(std::ranges::unique(surfaces).begin(), surfaces.end());
  nodes_ = by_node<BondNode>(marked, comm);
  std::vector<SentFaceAtBond> faces;
  std::vector<SentNodeAtBond> nodes;
  find_faces(surfaces, faces, nodes, comm);
  faces = comm.all_gather(faces);
  nodes = comm.all_gather(nodes);

  at_bond_.resize(pairs.size());
  for (std::size_t c = 0; c < pairs.size(); ++c)
    for (const int at_side : {0, 1}) {
      std::vector<SentNode> its_nodes;
      std::vector<SentFace> its_faces;
      std::map<Global, int> in_bond;
      for (const auto& n : nodes)
        if (n.bond == static_cast<int>(c) && n.side == at_side) its_nodes.push_back(n.node), in_bond[n.node.id] = n.in_bond;
      for (const auto& f : faces)
        if (f.bond == static_cast<int>(c) && f.side == at_side) its_faces.push_back(f.face);
      if (its_faces.empty()) continue;
      // A face may belong to several contacts.
      std::ranges::sort(its_faces, {}, &SentFace::nodes);
      its_faces.erase(std::ranges::unique(its_faces, {}, &SentFace::nodes).begin(), its_faces.end());
      for (std::size_t f = 0; f < its_faces.size(); ++f) its_faces[f].id = static_cast<Global>(f);
      auto& moved = at_bond_[c][static_cast<std::size_t>(at_side)];
      moved.faces = assemble(its_nodes, its_faces, kinematics);
      find_kinks(moved.faces);
      for (const Global id : moved.faces.node_id) moved.in_bond.push_back(static_cast<char>(in_bond.at(id)));
      if (const auto rotation = rotation_of(pairs[c].options))
        for (auto& x : moved.faces.points)
          x = at_side == 0 ? (*rotation)(x) : Point(rotation->rotation.transpose() * (x - rotation->translation));
      moved.alone = alone_of(moved.faces);
    }
}

void FacesAtBonds::find_faces(std::span<const mesh::Surface* const> surfaces, std::vector<SentFaceAtBond>& faces,
                              std::vector<SentNodeAtBond>& nodes, const Communicator& comm) const
{
  std::vector<Global> ids;
  for (const auto* surface : surfaces) ids.insert(ids.end(), surface->node_id.begin(), surface->node_id.end());
  std::ranges::sort(ids);
  ids.erase(std::ranges::unique(ids).begin(), ids.end());
  const auto asked = ask(ids, comm);
  const auto key = [](const BondNode& n) { return std::tuple(n.node, n.bond, n.side); };
  const auto in_order = [&](std::vector<BondNode> some) {
    std::ranges::sort(some, {}, key);
    some.erase(std::ranges::unique(some, {}, key).begin(), some.end());
    return some;
  };
  const auto of_bonds = in_order(answer(nodes_, asked, comm));
  auto round = of_bonds;
  for (int ring = 1; ring <= rings_beyond; ++ring) {
    std::vector<BondNode> next;
    for (const auto* surface : surfaces)
      for (std::size_t f = 0; f < surface->faces.size(); ++f) {
        std::vector<std::pair<int, int>> met;  // bonds and their sides
        for (const Local n : surface->faces[f])
          for (const auto& mark :
               std::ranges::equal_range(round, surface->node_id[static_cast<std::size_t>(n)], {}, &BondNode::node))
            met.emplace_back(mark.bond, mark.side);
        std::ranges::sort(met);
        met.erase(std::ranges::unique(met).begin(), met.end());
        for (const auto& [bond, at_side] : met) {
          if (ring == rings_beyond) faces.push_back({bond, at_side, pack_face(*surface, f)});
          for (const Local n : surface->faces[f]) {
            const Global node = surface->node_id[static_cast<std::size_t>(n)];
            if (ring == rings_beyond)
              nodes.push_back({bond, at_side, pack_node(*surface, static_cast<std::size_t>(n)),
                               std::ranges::binary_search(of_bonds, std::tuple(node, bond, at_side), {}, key) ? 1 : 0});
            else
              next.push_back({node, bond, at_side});
          }
        }
      }
    if (ring < rings_beyond) round = in_order(answer(by_node<BondNode>(in_order(std::move(next)), comm), asked, comm));
  }
}

std::vector<FacesAtBonds::AtBond> FacesAtBonds::nodes_of(const Side& side, const Communicator& comm) const
{
  if (at_bond_.empty()) return {};
  std::map<std::pair<int, int>, std::vector<Local>> found;
  for (const auto& n : answer(nodes_, ask(side.node_id, comm), comm))
    found[{n.bond, n.side}].push_back(static_cast<Local>(std::ranges::lower_bound(side.node_id, n.node) - side.node_id.begin()));
  std::vector<AtBond> result;
  for (auto& [at, nodes] : found) result.push_back({at.first, at.second, std::move(nodes)});
  return result;
}

std::vector<std::vector<Local>> tied_together(std::span<const FacesAtBonds::AtBond> nodes)
{
  std::map<int, std::vector<Local>> of_bond;
  for (const auto& at : nodes) of_bond[at.bond].insert(of_bond[at.bond].end(), at.nodes.begin(), at.nodes.end());
  std::vector<std::vector<Local>> result;
  for (auto& [bond, together] : of_bond) result.push_back(std::move(together));
  return result;
}

// Of a node of the side each corner, with what comes nearest to its normal beyond. Sharp edges have no vote.
GoesOn FacesAtBonds::go_on(const Side& side, std::span<const SurfaceNodes> alone, const NodeCorners& corners, const Moved& beyond,
                           const NodeCorners& corners_beyond)
{
  GoesOn result = GoesOn::yes;
  for (const auto& corner : corners) {
    const Point face = side.geometry(corner.first).normal();
    const auto normal_beyond = [&](const auto& other) { return beyond.faces.geometry(other.first).normal(); };
    const auto nearest =
        std::ranges::min_element(corners_beyond, {}, [&](const auto& other) { return (normal_beyond(other) - face).norm(); });
    bool goes = false;
    for (std::size_t i = 0; i < alone.size() && !goes; ++i)
      goes = goes_on(face, alone[i].normal(side, corner.first, corner.second), normal_beyond(*nearest),
                     beyond.alone[i].normal(beyond.faces, nearest->first, nearest->second));
    if (!goes && face.dot(normal_beyond(*nearest)) <= kink) return GoesOn::not_asked;
    if (!goes) result = GoesOn::no;
  }
  return result;
}

// Says no for the nodes of edges at which curved faces of both meet at a kink.
void FacesAtBonds::deny_at_kinks_of_curved(const CurvedBorders& here, const Side& beyond, std::span<const Met> met,
                                           std::span<GoesOn> votes)
{
  const CurvedBorders there(beyond);
  std::multimap<Local, Local> nodes;
  for (const Met& m : met) nodes.emplace(static_cast<Local>(m.here), static_cast<Local>(m.beyond));
  std::map<FacetEdge, const CurvedBorders::Edge*> edges;
  for (const auto& edge : there.edges()) edges[{edge.a, edge.b}] = &edge;
  for (const auto& edge : here.edges()) {
    const auto [first_a, last_a] = nodes.equal_range(edge.a);
    const auto [first_b, last_b] = nodes.equal_range(edge.b);
    for (auto a = first_a; a != last_a; ++a)
      for (auto b = first_b; b != last_b; ++b)
        if (const auto found = edges.find({std::min(a->second, b->second), std::max(a->second, b->second)});
            found != edges.end() && here.meets_at_kink(edge, there, *found->second))
          deny(edge.parts, votes);
  }
}

// The nodes of a side at a bond and those beyond that lie in the same places. Of several in one place those count that say most.
std::vector<FacesAtBonds::Met> FacesAtBonds::meet(const Beside& beside, std::span<const Local> nodes, const Moved& beyond)
{
  const auto& [side, alone, corners, borders] = beside;
  const auto corners_beyond = corners_of_nodes(beyond.faces);
  const auto edges = shortest_edges(beyond.faces);
  std::vector<Box> boxes;
  for (const Local n : nodes) {
    const Point& x = side.points[static_cast<std::size_t>(n)];
    boxes.emplace_back(x, x);
  }
  const Tree tree(std::move(boxes));
  std::vector<Met> result;
  std::vector<GoesOn> votes(side.points.size(), GoesOn::not_asked);
  for (std::size_t n = 0; n < beyond.in_bond.size(); ++n) {
    if (!beyond.in_bond[n]) continue;
    const Point& x = beyond.faces.points[n];
    for (const int i : tree.candidates(grown(Box(x, x), same_node_across * edges[n]))) {
      const auto here = static_cast<std::size_t>(nodes[static_cast<std::size_t>(i)]);
      const double distance = (side.points[here] - x).norm();
      if (distance > same_node_across * edges[n]) continue;
      const GoesOn said = go_on(side, alone, corners[here], beyond, corners_beyond[n]);
      if (said == GoesOn::not_asked) continue;
      votes[here] = std::max(votes[here], said);
      result.push_back({n, here, distance, said});
    }
  }
  deny_at_kinks_of_curved(borders, beyond.faces, result, votes);
  std::vector<FacetEdge> border;
  const auto asked = [&](Local n) { return votes[static_cast<std::size_t>(n)] != GoesOn::not_asked; };
  for (std::size_t f = 0; f < side.facets.size(); ++f)
    for (std::size_t k = 0; k < side.facets[f].size(); ++k)
      if (const Local a = side.facets[f][k], b = side.facets[f][(k + 1) % side.facets[f].size()]; asked(a) && asked(b))
        border.push_back({a, b});
  const auto own = votes;
  follow_neighbours(std::move(border), votes);
  std::erase_if(result, [&](const Met& met) { return votes[met.here] != GoesOn::yes || met.said < own[met.here]; });
  return result;
}

void FacesAtBonds::append_to(Side& whole, const Side& side, std::span<const SurfaceNodes> alone,
                             std::span<const AtBond> at_bonds) const
{
  if (at_bonds.empty()) return;
  const Beside beside{side, alone, corners_of_nodes(side), CurvedBorders(side)};
  for (const auto& [bond, at_side, nodes] : at_bonds) {
    const auto& beyond = at_bond_[static_cast<std::size_t>(bond)][static_cast<std::size_t>(1 - at_side)];
    const auto& points = beyond.faces.points;
    std::vector<Local> local(points.size(), -1);
    std::vector<char> common(local.size(), 0);
    std::vector<double> nearest(local.size(), std::numeric_limits<double>::max());
    for (const auto& [n, here, distance, said] : meet(beside, nodes, beyond))
      if (distance <= nearest[n]) nearest[n] = distance, local[n] = static_cast<Local>(here), common[n] = 1;
    const auto chosen = facets_round(beyond.faces.facets, common);
    for (std::size_t f = 0; f < chosen.size(); ++f) {
      if (!chosen[f]) continue;
      std::vector<Local> facet;
      for (const Local n : beyond.faces.facets[f]) {
        auto& here = local[static_cast<std::size_t>(n)];
        if (here < 0) {
          here = static_cast<Local>(whole.points.size());
          whole.points.push_back(points[static_cast<std::size_t>(n)]);
        }
        facet.push_back(here);
      }
      whole.facets.add(beyond.faces.facets.type[f], facet);
    }
    append_kinks(whole, beyond.faces, [&](Local n) { return local[static_cast<std::size_t>(n)]; });
  }
}

}  // namespace mortise::contact
