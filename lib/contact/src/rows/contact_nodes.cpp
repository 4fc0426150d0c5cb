#include "rows/contact_nodes.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <span>

#include "rows/tied_by_others.hpp"

namespace mortise::contact {

namespace {

// Less than this part of a facet is covered by chance.
constexpr double least_piece = 0.01;
// Of a face: a bond goes without less, where its nodes are held otherwise.
constexpr double least_part_of_bond = 0.1;
// A node that looks past the border with more of its surroundings covered is one on it.
constexpr double most_cover = 0.6;

// Where functions with half of a piece's cover would be dropped, as opposite a foot smaller than the faces it stands on, they
// stay: so does the border of the contact.
void keep_small_pieces(const Side& secondary, CutFaces& faces, const std::vector<char>& allowed, std::vector<char>& keep)
{
  std::vector<std::size_t> more;
  for (const std::size_t f : faces.round())
    for (const std::size_t i : faces.pieces(f)) {
      const auto piece = faces.piece(i);
      if (piece.point_facet.empty()) continue;
      const double facets = piece.facet < 0 ? static_cast<double>(secondary.facets_of(f)) : 1;
      if (piece.covered.sum() < least_piece / facets * piece.whole.sum()) continue;
      double kept = 0;  // of the cover
      for (Eigen::Index k = 0; k < piece.covered.size(); ++k)
        if (keep[faces.place_of(f, piece, k)]) kept += piece.covered[k];
      if (kept > 0.5 * piece.covered.sum()) continue;
      for (Eigen::Index k = 0; k < piece.covered.size(); ++k)
        if (const auto p = faces.place_of(f, piece, k); allowed[p] && piece.covered[k] > 0) more.push_back(p);
    }
  for (const std::size_t p : more) keep[p] = 1;
}

// A corner of the primary side keeps its row, however little of a face it reaches, and so do the others of its piece: what they
// left to each other would act elsewhere.
void keep_corners(CutFaces& faces, const std::vector<char>& allowed, std::vector<char>& keep)
{
  for (const std::size_t f : faces.round())
    for (const std::size_t i : faces.pieces(f)) {
      const auto piece = faces.piece(i);
      if (std::all_of(piece.corner.begin(), piece.corner.end(), [](Local corner) { return corner < 0; })) continue;
      for (Eigen::Index k = 0; k < piece.covered.size(); ++k)
        if (const auto p = faces.place_of(f, piece, k); allowed[p] && piece.covered[k] > 0) keep[p] = 1;
    }
}

// Surface nodes past the border of the primary side that share faces with others, all of which hold whole faces, or whole facets
// beside these. `met`: which the primary side lies opposite; `holding`: which have multipliers whatever happens here.
std::vector<char> past_the_border(const Side& side, const SurfaceNodes& surface_nodes, std::span<const char> met,
                                  std::span<const char> holding, std::span<const double> cover)
{
  const auto at = [](const mesh::Cells& cells, const std::vector<Local>& places, std::size_t f) {
    return std::span(places).subspan(static_cast<std::size_t>(cells.offset[f]), cells[f].size());
  };
  const auto is = [](std::span<const char> marks, Local p) { return marks[static_cast<std::size_t>(p)] != 0; };
  const auto whole = [&](std::span<const Local> nodes) {
    return std::ranges::all_of(nodes, [&](Local p) { return is(met, p) && is(holding, p); });
  };
  std::vector<char> in_face(met.size(), 0), beside_some(met.size(), 0), beside_weak(met.size(), 0);
  for (std::size_t f = 0; f < side.faces.size(); ++f)
    if (const auto nodes = at(side.faces, surface_nodes.of_node, f); whole(nodes))
      for (const Local p : nodes) in_face[static_cast<std::size_t>(p)] = 1;
  auto holds = in_face;
  for (std::size_t f = 0; f < side.facets.size(); ++f)
    if (const auto corners = at(side.facets, surface_nodes.of_corner, f);
        whole(corners) && std::ranges::any_of(corners, [&](Local p) { return is(in_face, p); }))
      for (const Local p : corners) holds[static_cast<std::size_t>(p)] = 1;
  for (std::size_t f = 0; f < side.faces.size(); ++f)
    for (const auto nodes = at(side.faces, surface_nodes.of_node, f); const Local p : nodes)
      for (const Local q : nodes)
        if (!is(met, p) && is(met, q)) (is(holds, q) ? beside_some : beside_weak)[static_cast<std::size_t>(p)] = 1;
  std::vector<char> result(met.size(), 0);
  for (std::size_t p = 0; p < result.size(); ++p) result[p] = beside_some[p] && !beside_weak[p] && cover[p] < most_cover;
  return result;
}

// Of a piece that would lose all its functions the one with the largest cover stays, for the pressure of all of it.
void keep_one_of_each_piece(CutFaces& faces, std::span<const char> past, std::vector<char>& keep)
{
  std::vector<std::size_t> more;
  for (const std::size_t f : faces.round())
    for (const std::size_t i : faces.pieces(f)) {
      const auto piece = faces.piece(i);
      std::optional<std::size_t> largest;
      double most = 0;
      bool has = false;
      for (Eigen::Index k = 0; k < piece.covered.size(); ++k) {
        const auto p = faces.place_of(f, piece, k);
        has = has || keep[p];
        if (past[faces.surface_node(p)] && piece.covered[k] > most) most = piece.covered[k], largest = p;
      }
      if (!has && largest) more.push_back(*largest);
    }
  for (const std::size_t p : more) keep[p] = 1;
}

// The part of a face that is covered.
double cover_of_face(CutFaces& faces, std::size_t face)
{
  double covered = 0, whole = 0;
  for (const std::size_t i : faces.pieces(face)) {
    covered += faces.piece(i).covered.sum();
    whole += faces.piece(i).whole.sum();
  }
  return whole > 0 ? covered / whole : 0;
}

// Marks the surface nodes of faces that count at which `holds` of all of them.
template <class Holds, class Counts>
std::vector<char> at_all_nodes_of_a_face(const CutFaces& faces, std::size_t count, const Holds& holds, const Counts& counts)
{
  std::vector<char> result(count, 0);
  for (const std::size_t f : faces.round()) {
    const auto surface_nodes = faces.surface_nodes_of(f);
    if (std::ranges::all_of(surface_nodes, [&](Local p) { return holds(static_cast<std::size_t>(p)); }) && counts(f))
      for (const Local p : surface_nodes) result[static_cast<std::size_t>(p)] = 1;
  }
  return result;
}

// The areas round each surface node: covered, and all. In the order of the faces, whatever the ranks.
std::vector<double> sum_areas(CutFaces& faces, std::vector<double>& covered)
{
  std::vector<double> whole(covered.size(), 0.0);
  for (const std::size_t f : faces.round())
    for (const std::size_t i : faces.pieces(f)) {
      const auto piece = faces.piece(i);
      for (Eigen::Index k = 0; k < piece.covered.size(); ++k) {
        covered[faces.place_of(f, piece, k)] += piece.covered[k];
        whole[faces.surface_node_of(f, piece, k)] += piece.whole[k];
      }
    }
  return whole;
}

// Along which directions each node moves, by what supports prescribe of it.
std::vector<Directions> directions_of_nodes(const Side& secondary, const SurfaceNodes& surface_nodes, const CutFaces& faces,
                                            const SupportedNodes& supports, int dimension)
{
  std::vector<Directions> result;
  result.reserve(faces.places());
  for (std::size_t p = 0; p < faces.places(); ++p) {
    const auto& surface_node = surface_nodes.all[faces.surface_node(p)];
    const Global node = secondary.node_id[static_cast<std::size_t>(surface_node.node)];
    const std::array<bool, 3> prescribed{supports.find(node, 0) != nullptr, supports.find(node, 1) != nullptr,
                                         supports.find(node, 2) != nullptr};
    result.push_back(directions(surface_node.normal, prescribed, supports.skew_supports(node), dimension));
  }
  return result;
}

// Marks the surface nodes of a bond past the primary side's border, prescribed along their normal, whose share the others hold:
// what such a node sees is the primary side alone, which it would hold to what the few nodes that move leave of the face, as
// stiffly as that. `met`: as BondedNodes has it; `whole`: the area round each node.
std::vector<char> tied_past_the_border(const Side& secondary, CutFaces& faces, std::span<const char> met,
                                       const ContactNodes& nodes, std::span<const double> whole, int dimension)
{
  std::vector<char> aside(met.size(), 0);
  auto stay = aside;
  for (std::size_t p = 0; p < aside.size(); ++p) {
    aside[p] = !nodes.directions[p].free_normal && !met[p];
    stay[p] = !aside[p] && nodes.covered[p] > least_cover * whole[p];
  }
  return tied_by_others(secondary, faces, aside, stay, dimension);
}

}  // namespace

std::vector<char> nodes_of_both_sides(const Side& secondary, const SurfaceNodes& surface_nodes, const Side& primary)
{
  const auto of_primary = [&](Local node) {
    return std::ranges::binary_search(primary.node_id, secondary.node_id[static_cast<std::size_t>(node)]);
  };
  std::vector<char> result;
  for (const auto& node : surface_nodes.all) result.push_back(of_primary(node.node) ? 1 : 0);
  if (std::ranges::find(result, 1) == result.end()) return result;
  for (std::size_t f = 0; f < secondary.faces.size(); ++f) {
    const auto face = secondary.faces[f];
    if (!std::ranges::all_of(face, of_primary)) continue;
    for (std::size_t p = 0; p < result.size(); ++p)
      if (std::ranges::find(face, surface_nodes.all[p].node) != face.end()) result[p] = 0;
  }
  return result;
}

std::vector<double> cover_of_nodes(CutFaces& faces, std::size_t count)
{
  std::vector<double> cover(faces.places(), 0.0);
  const auto whole = sum_areas(faces, cover);
  for (std::size_t p = 0; p < count; ++p) cover[p] = whole[p] > 0 ? std::min(cover[p] / whole[p], 1.0) : 0.0;
  cover.resize(count);
  return cover;
}

ContactNodes choose_contact_nodes(const Side& secondary, const SurfaceNodes& surface_nodes, CutFaces& faces,
                                  const SupportedNodes& supports, const std::vector<char>& one_node,
                                  const std::vector<char>& primary_prescribed, const std::optional<BondedNodes>& bond,
                                  int dimension)
{
  const auto count = faces.places();
  ContactNodes nodes;
  nodes.covered.assign(count, 0.0);
  const auto whole = sum_areas(faces, nodes.covered);
  nodes.directions = directions_of_nodes(secondary, surface_nodes, faces, supports, dimension);
  // Surface nodes prescribed along their normal keep their rows where the primary side can move: it alone feels them. Where it is
  // held as well they leave their share to the others of the face, as those at a seam's end do: a function sees a little of the
  // nodes beside the held ones, which alone would answer for all that it presses, and a bond would hold the mean of what it meets
  // once more. Where a face has no others, as on a surface that a support moves as a whole, they stay; rows in which nothing
  // moves, as those of an obstacle, are dropped.
  // Past the primary side's border those of a bond stay only where the others do not hold what is covered.
  std::vector<char> others_hold;
  if (bond && !bond->met.empty()) others_hold = tied_past_the_border(secondary, faces, bond->met, nodes, whole, dimension);
  const auto left_to_others = [&](std::size_t p) { return bond && bond->left_to_others[faces.surface_node(p)]; };
  const auto needed = [&](std::size_t place) {
    const auto p = faces.surface_node(place);
    return !primary_prescribed[p] && (others_hold.empty() || !others_hold[p]) && !left_to_others(place);
  };
  const auto left_out = [&](std::size_t p) {
    return one_node[faces.surface_node(p)] || (!nodes.directions[p].free_normal && !needed(p)) || left_to_others(p);
  };
  nodes.stranded = at_all_nodes_of_a_face(
      faces, count, [&](std::size_t p) { return left_out(p) || (!bond && !nodes.directions[p].free_normal); },
      [](std::size_t) { return true; });
  const auto without_others = at_all_nodes_of_a_face(
      faces, count, left_out, [&](std::size_t f) { return !bond || cover_of_face(faces, f) > least_part_of_bond; });
  std::vector<char> allowed(count, 0);
  nodes.cover.assign(count, 0);
  nodes.kept.assign(count, 0);
  nodes.shared.assign(count, 0);
  nodes.freed.assign(count, 0);
  for (std::size_t p = 0; p < count; ++p) {
    nodes.freed[p] = (without_others[p] || needed(p)) && !nodes.directions[p].free_normal;
    allowed[p] = !one_node[faces.surface_node(p)] && (!left_out(p) || without_others[p] || nodes.freed[p]);
    if (nodes.freed[p])  // what moves decides about the tangents
      nodes.directions[p] = directions(surface_nodes.all[faces.surface_node(p)].normal, {false, false, false}, {}, dimension);
    nodes.cover[p] = whole[p] > 0 ? std::min(nodes.covered[p] / whole[p], 1.0) : 0.0;
    nodes.kept[p] = allowed[p] && nodes.cover[p] > least_cover;
    nodes.shared[p] = !allowed[p] && nodes.cover[p] > least_cover;
  }
  keep_small_pieces(secondary, faces, allowed, nodes.kept);
  keep_corners(faces, allowed, nodes.kept);
  if (!bond || bond->met.empty()) return nodes;
  std::vector<char> holding(surface_nodes.all.size(), 0);
  for (std::size_t p = 0; p < holding.size(); ++p) holding[p] = !left_out(p);
  const auto past = past_the_border(secondary, surface_nodes, bond->met, holding, nodes.cover);
  for (std::size_t p = 0; p < past.size(); ++p) nodes.kept[p] = nodes.kept[p] && !past[p];
  keep_one_of_each_piece(faces, past, nodes.kept);
  return nodes;
}

}  // namespace mortise::contact
