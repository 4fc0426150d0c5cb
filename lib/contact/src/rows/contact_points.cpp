#include "rows/contact_points.hpp"

#include <algorithm>
#include <map>

#include "integrals/covered_basis.hpp"
#include "rows/by_node.hpp"

namespace mortise::contact {

namespace {

constexpr double beside_edge_of_facet = 0.05, on_edge_of_facet = 1e-6;  // shape functions
constexpr double straight_border = 0.7;                                 // cosine: beyond a corner is another border

// A surface node whose place is between nodes.
struct Taken {
  Global node;
  std::array<double, 3> normal;
};

// A node that faces of second order round a place have in common.
struct PlaceCorner {
  Global node;
};

class Selection {
 public:
  Selection(const Side& secondary, const SurfaceNodes& surface_nodes, const CutFaces& faces,
            const std::function<Cover(std::size_t face)>& cover)
      : secondary_(secondary),
        nodes_(surface_nodes),
        cover_(cover),
        faces_at_(secondary.points.size()),
        facets_at_(secondary.points.size())
  {
    for (const std::size_t f : faces.round()) {
      for (const Local n : secondary.faces[f]) faces_at_[static_cast<std::size_t>(n)].push_back(f);
      for (auto facet = static_cast<std::size_t>(secondary.first_facet[f]);
           facet < static_cast<std::size_t>(secondary.first_facet[f + 1]); ++facet)
        for (const Local n : secondary.facets[facet]) facets_at_[static_cast<std::size_t>(n)].push_back(facet);
    }
  }

  // Whether one body covers the face of a facet as a whole, and no other what is round its corners.
  bool one_body_covers(std::size_t facet)
  {
    const auto face = static_cast<std::size_t>(secondary_.face_of[facet]);
    const Cover here = cover_of(face);
    if (here.part < 1 - slit || here.body < 0) return false;
    return std::ranges::all_of(secondary_.facets[facet], [&](Local corner) {
      return std::ranges::all_of(faces_at_[static_cast<std::size_t>(corner)], [&](std::size_t f) {
        const Cover beside = cover_of(f);
        return beside.part == 0 || beside.body == here.body;
      });
    });
  }

  ContactPoint place(std::size_t p, const NearestPoint& nearest) const
  {
    const auto id = [&](Local n) { return secondary_.node_id[static_cast<std::size_t>(n)]; };
    ContactPoint place{p, id(nodes_.all[p].node), {nearest.facet, nearest.shape}, Point::Zero(), Point::Zero(), {}, {}, {}};
    const auto corners = secondary_.facets[nearest.facet];
    for (std::size_t c = 0; c < corners.size(); ++c) {
      const auto corner = static_cast<std::size_t>(corners[c]);
      place.at += nearest.shape[static_cast<Eigen::Index>(c)] * secondary_.points[corner];
      place.normal += nearest.shape[static_cast<Eigen::Index>(c)] * nodes_.normal(secondary_, nearest.facet, c);
      place.corners.push_back(id(corners[c]));
      place.facet.push_back(at(corners[c]));
      // On an edge or next to it the nodes round that, so that those on both of its sides count alike.
      if (nearest.shape[static_cast<Eigen::Index>(c)] < beside_edge_of_facet) continue;
      for (const std::size_t f : faces_at_[corner])
        for (const Local n : secondary_.faces[f]) place.round.push_back(id(n));
    }
    place.normal.normalize();
    if (const auto [a, b] = border_edge(nearest); a >= 0) {
      place.edge = (at(b) - at(a)).normalized();
      place.round = {id(a), id(b)};
      for (const auto& [end, direction] : {std::pair(a, Point(-place.edge)), std::pair(b, place.edge)})
        if (const Local n = next_on_border(end, direction); n >= 0) place.round.push_back(id(n));
    }
    std::ranges::sort(place.round);
    place.round.erase(std::ranges::unique(place.round).begin(), place.round.end());
    return place;
  }

 private:
  const Point& at(Local n) const { return secondary_.points[static_cast<std::size_t>(n)]; }

  // The edge of the border that a place is on, or -1.
  std::pair<Local, Local> border_edge(const NearestPoint& nearest) const
  {
    const auto corners = secondary_.facets[nearest.facet];
    Few<Local, 4> ends;
    for (std::size_t c = 0; c < corners.size(); ++c)
      if (nearest.shape[static_cast<Eigen::Index>(c)] > on_edge_of_facet) ends.push_back(corners[c]);
    if (corners.size() == 2 || ends.size() != 2 || facets_with(ends[0], ends[1]) != 1) return {-1, -1};
    return {ends[0], ends[1]};
  }

  // How many facets have the edge from a to b.
  long facets_with(Local a, Local b) const
  {
    return std::ranges::count_if(facets_at_[static_cast<std::size_t>(a)], [&](std::size_t facet) {
      const auto corners = secondary_.facets[facet];
      for (std::size_t c = 0; c < corners.size(); ++c) {
        const Local next = corners[(c + 1) % corners.size()];
        if ((corners[c] == a && next == b) || (corners[c] == b && next == a)) return true;
      }
      return false;
    });
  }

  // The node that the border goes on to from another, along a direction, or -1.
  Local next_on_border(Local from, const Point& direction) const
  {
    for (const std::size_t facet : facets_at_[static_cast<std::size_t>(from)])
      for (const Local n : secondary_.facets[facet])
        if (n != from && (at(n) - at(from)).normalized().dot(direction) > straight_border && facets_with(from, n) == 1) return n;
    return -1;
  }

  const Cover& cover_of(std::size_t face)
  {
    const auto [known, first] = covers_.try_emplace(face);
    if (first) known->second = cover_(face);
    return known->second;
  }

  const Side& secondary_;
  const SurfaceNodes& nodes_;
  const std::function<Cover(std::size_t face)>& cover_;
  std::vector<std::vector<std::size_t>> faces_at_, facets_at_;  // of each node
  std::map<std::size_t, Cover> covers_;                         // of the faces that were asked about
};

}  // namespace

ContactPoints take_contact_points(std::vector<NearestPoint>& nearest, const Side& secondary, const SurfaceNodes& surface_nodes,
                                  const CutFaces& faces, const std::vector<char>& own,
                                  const std::function<Cover(std::size_t face)>& cover, const Communicator& comm)
{
  constexpr double same = 0.999;  // cosine of normals
  // Of its shape function: such a node may as well stand in for the place. In facets of faces of second order, among neighbours
  // whose functions are those of whole faces, it would bear a tenth too much.
  constexpr double beside_node = 0.85, beside_node_of_second_order = 0.995;
  ContactPoints result{{}, std::vector<char>(secondary.faces.size(), 0)};
  if (!comm.any(std::ranges::any_of(nearest, &NearestPoint::moved))) return result;
  Selection selection(secondary, surface_nodes, faces, cover);
  // The rank of a node sees all faces round the place; the others are told.
  std::vector<Taken> mine;
  std::vector<PlaceCorner> corners;
  for (std::size_t p = 0; p < nearest.size(); ++p) {
    const auto& node = surface_nodes.all[p];
    const bool second_order = secondary.second_order(static_cast<std::size_t>(secondary.face_of[nearest[p].facet]));
    const double beside = second_order ? beside_node_of_second_order : beside_node;
    if (!own[static_cast<std::size_t>(node.node)] || !nearest[p].moved() || nearest[p].shape.maxCoeff() > beside ||
        !selection.one_body_covers(nearest[p].facet))
      continue;
    result.places.push_back(selection.place(p, nearest[p]));
    const auto& place = result.places.back();
    mine.push_back({place.node, {node.normal[0], node.normal[1], node.normal[2]}});
    if (second_order)
      for (const Global corner : place.corners) corners.push_back({corner});
  }
  const auto asked = ask(secondary.node_id, comm);
  const auto taken = answer(by_node<Taken>(mine, comm), asked, comm);
  for (std::size_t p = 0; p < nearest.size(); ++p) {
    const auto& node = surface_nodes.all[p];
    const auto here = std::ranges::equal_range(taken, secondary.node_id[static_cast<std::size_t>(node.node)], {}, &Taken::node);
    if (std::ranges::any_of(here,
                            [&](const Taken& t) { return Point(t.normal[0], t.normal[1], t.normal[2]).dot(node.normal) > same; }))
      nearest[p] = {};
  }
  const auto common = answer(by_node<PlaceCorner>(corners, comm), asked, comm);
  for (const std::size_t f : faces.round())
    result.in_facets[f] =
        secondary.second_order(f) && std::ranges::any_of(secondary.faces[f], [&](Local n) {
          return std::ranges::binary_search(common, secondary.node_id[static_cast<std::size_t>(n)], {}, &PlaceCorner::node);
        });
  return result;
}

}  // namespace mortise::contact
