#include "continued_side.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include "by_node.hpp"
#include "contact/cyclic.hpp"
#include "skin.hpp"
#include "tree.hpp"

namespace mortise::contact {

namespace {

// Facets that share nodes with the border, and those that share nodes with them: a normal asks for no others.
constexpr int rings_beyond = 2;
constexpr double same_node_across = 1e-3;  // of the shortest edge there
// The normals of both sides alone at a border may differ by this part of what the faces there do: more is a kink. So is less than
// minus that part, as at a groove beside a bump; but for what is far below, as of a flat bottom with steep ends, of whose curvature
// the two rows of nodes beside the border say nothing.
constexpr double of_a_kink = 0.5, of_steep_ends = 3;

// A face of a contact next to a bond, and a node of it, on their way.
struct SentFaceAtBond {
  int bond, side;
  SentFace face;
};
struct SentNodeAtBond {
  int bond, side;
  SentNode node;
  int in_bond;
};

// Marks the facets that share a node with those marked, ring by ring.
std::vector<char> facets_round(const mesh::Cells& facets, std::vector<char> nodes)
{
  std::vector<char> result(facets.size(), 0);
  for (int ring = 0; ring < rings_beyond; ++ring) {
    for (std::size_t f = 0; f < facets.size(); ++f)
      for (const Local n : facets[f])
        if (nodes[static_cast<std::size_t>(n)]) result[f] = 1;
    for (std::size_t f = 0; f < facets.size(); ++f)
      for (const Local n : facets[f])
        if (result[f]) nodes[static_cast<std::size_t>(n)] = 1;
  }
  return result;
}

// Of each node the shortest edge of a facet there.
std::vector<double> shortest_edges(const Side& side)
{
  std::vector<double> result(side.points.size(), std::numeric_limits<double>::max());
  for (std::size_t f = 0; f < side.facets.size(); ++f) {
    const auto nodes = side.facets[f];
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      const auto a = static_cast<std::size_t>(nodes[k]), b = static_cast<std::size_t>(nodes[(k + 1) % nodes.size()]);
      const double length = (side.points[a] - side.points[b]).norm();
      result[a] = std::min(result[a], length);
      result[b] = std::min(result[b], length);
    }
  }
  return result;
}

// The surface nodes of a side by itself, with the normals of the surface through the nodes, and with those that continue the
// curvature of the faces beside the border, of which one may be right where the other is not.
std::array<SurfaceNodes, 2> alone_of(const Side& side)
{
  return {surface_nodes_of_facets(side), surface_nodes_of_facets(side, false)};
}

// The corners of facets at each node: facets, and its place in them.
using CornersOfNodes = std::vector<std::vector<std::pair<std::size_t, std::size_t>>>;
CornersOfNodes corners_of_nodes(const Side& side)
{
  CornersOfNodes result(side.points.size());
  for (std::size_t f = 0; f < side.facets.size(); ++f)
    for (std::size_t k = 0; k < side.facets[f].size(); ++k) result[static_cast<std::size_t>(side.facets[f][k])].emplace_back(f, k);
  return result;
}

// Whether there is no kink where faces with these normals meet and the normals of each side alone are these.
bool goes_on(const Point& face, const Point& alone, const Point& other_face, const Point& other_alone)
{
  const Point faces = other_face - face, nodes = other_alone - alone;
  if (nodes.norm() < rounding) return true;
  const double part = nodes.dot(faces) / faces.squaredNorm();
  return std::abs(part) <= of_a_kink || part < -of_steep_ends;
}

// A plane of symmetry, and which points of a side lie in it.
struct SymmetryPlane {
  Point normal;
  double offset;
  std::vector<char> has;

  double height(const Point& x) const { return normal.dot(x) - offset; }
};

// The planes of symmetry that a side ends in.
class SymmetryPlanes {
 public:
  SymmetryPlanes(const Side& side, std::span<const SurfaceNodes> alone, const SupportedNodes& supports)
      : side_(side), alone_(alone), supports_(supports), corners_(corners_of_nodes(side))
  {
    for (std::size_t f = 0; f < side.facets.size(); ++f) add_border_of(f);
  }

  std::vector<SymmetryPlane>& all() { return planes_; }

  // Normals lie in the plane; of nodes there that the side does not meet it at a right angle at, they are what they were.
  void settle(const SymmetryPlane& plane, SurfaceNodes& of_whole) const
  {
    for (std::size_t f = 0; f < side_.facets.size(); ++f)
      for (std::size_t k = 0; k < side_.facets[f].size(); ++k) {
        const Local n = side_.facets[f][k];
        auto& normal = of_whole.all[static_cast<std::size_t>(
            of_whole.of_corner[static_cast<std::size_t>(side_.facets.offset[f]) + k])].normal;
        if (plane.has[static_cast<std::size_t>(n)])
          normal = (normal - normal.dot(plane.normal) * plane.normal).normalized();
        else if (std::abs(plane.height(at(n))) < rounding * side_.geometry(f).size())
          normal = alone_[0].normal(side_, f, k);
      }
  }

 private:
  void add_border_of(std::size_t f)
  {
    const auto nodes = side_.facets[f];
    if (nodes.size() == 2) {
      for (const Local n : nodes)
        if (corners_[static_cast<std::size_t>(n)].size() == 1) add(n, n);
      return;
    }
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      const Local a = nodes[k], b = nodes[(k + 1) % nodes.size()];
      if (at_border(a, b)) add(a, b);
    }
  }

  // Whether one facet alone has the edge from a to b.
  bool at_border(Local a, Local b) const
  {
    int count = 0;
    for (const auto& [f, k] : corners_[static_cast<std::size_t>(a)]) {
      const auto nodes = side_.facets[f];
      count += nodes[(k + 1) % nodes.size()] == b || nodes[(k + nodes.size() - 1) % nodes.size()] == b;
    }
    return count == 1;
  }

  const Point& at(Local n) const { return side_.points[static_cast<std::size_t>(n)]; }

  std::vector<Point> held(Local n) const
  {
    const Global node = side_.node_id[static_cast<std::size_t>(n)];
    std::vector<Point> result;
    for (int c = 0; c < 3; ++c)
      if (supports_.find(node, c)) result.push_back(Point::Unit(c));
    for (const auto& skew : supports_.skew_supports(node)) result.push_back(along(skew));
    return result;
  }

  bool is_symmetric(Local n, const Point& direction) const
  {
    const auto image = [&](const Point& x) { return Point(x - 2 * x.dot(direction) * direction); };
    return std::ranges::all_of(corners_[static_cast<std::size_t>(n)], [&](const auto& corner) {
      const Point face = side_.geometry(corner.first).normal();
      return std::abs(face.dot(direction)) < 0.5 && std::ranges::any_of(alone_, [&](const SurfaceNodes& alone) {
               const Point& normal = alone.normal(side_, corner.first, corner.second);
               return goes_on(face, normal, image(face), image(normal));
             });
    });
  }

  // The edge from a to b, or the end a = b of a curve.
  void add(Local a, Local b)
  {
    const double length = (at(a) - at(b)).norm();
    for (const Point& m : held(a)) {
      if (std::abs(m.dot(at(b) - at(a))) > rounding * length) continue;
      const auto of_b = held(b);
      if (std::ranges::none_of(of_b, [&](const Point& o) { return std::abs(o.dot(m)) > 1 - rounding; })) continue;
      for (const Local n : {a, b})
        if (is_symmetric(n, m)) plane_of(m, n).has[static_cast<std::size_t>(n)] = 1;
    }
  }

  SymmetryPlane& plane_of(const Point& m, Local n)
  {
    const double size = side_.geometry(corners_[static_cast<std::size_t>(n)][0].first).size();
    for (auto& plane : planes_)
      if (std::abs(plane.normal.dot(m)) > 1 - rounding * rounding && std::abs(plane.height(at(n))) < rounding * size) return plane;
    return planes_.emplace_back(m, m.dot(at(n)), std::vector<char>(side_.points.size(), 0));
  }

  const Side& side_;
  std::span<const SurfaceNodes> alone_;  // see alone_of()
  const SupportedNodes& supports_;
  CornersOfNodes corners_;
  std::vector<SymmetryPlane> planes_;
};

// Points that lie in a plane and were appended after it was found.
void find_appended(const Side& side, SymmetryPlane& plane)
{
  const auto edges = shortest_edges(side);
  for (std::size_t n = plane.has.size(); n < side.points.size(); ++n)
    plane.has.push_back(std::abs(plane.height(side.points[n])) < rounding * edges[n] ? 1 : 0);
}

void append_image(Side& side, const SymmetryPlane& plane)
{
  const auto near = facets_round(side.facets, plane.has);
  std::vector<Local> image(side.points.size(), -1), reversed;
  const std::size_t count = side.facets.size();
  for (std::size_t f = 0; f < count; ++f) {
    if (!near[f]) continue;
    reversed.assign(side.facets[f].rbegin(), side.facets[f].rend());
    for (Local& n : reversed) {
      const auto of = static_cast<std::size_t>(n);
      if (plane.has[of]) continue;
      if (image[of] < 0) {
        image[of] = static_cast<Local>(side.points.size());
        const Point x = side.points[of];
        side.points.push_back(x - 2 * plane.height(x) * plane.normal);
      }
      n = image[of];
    }
    side.facets.add(mesh::CellType(side.facets.type[f]), reversed);
  }
}

// The surface nodes of `whole`, whose first points and facets are those of `side`, without what belongs to others alone.
SurfaceNodes of_first(const Side& side, const SurfaceNodes& whole)
{
  SurfaceNodes result;
  std::vector<Local> kept(whole.all.size(), -1);
  for (std::size_t c = 0; c < side.facets.nodes.size(); ++c) kept[static_cast<std::size_t>(whole.of_corner[c])] = 0;
  for (std::size_t p = 0; p < kept.size(); ++p) {
    if (kept[p] < 0) continue;
    kept[p] = static_cast<Local>(result.all.size());
    result.all.push_back(whole.all[p]);
  }
  for (std::size_t c = 0; c < side.facets.nodes.size(); ++c)
    result.of_corner.push_back(kept[static_cast<std::size_t>(whole.of_corner[c])]);
  number_nodes_of_faces(side, result);
  return result;
}

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
  nodes_ = by_node<BondNode>(marked, comm);

  // The faces within two rings of the bonds' nodes.
  std::ranges::sort(surfaces);
  surfaces.erase(std::ranges::unique(surfaces).begin(), surfaces.end());
  std::vector<Global> ids;
  for (const auto* surface : surfaces) ids.insert(ids.end(), surface->node_id.begin(), surface->node_id.end());
  std::ranges::sort(ids);
  ids.erase(std::ranges::unique(ids).begin(), ids.end());
  const auto asked = ask(ids, comm);
  const auto key = [](const BondNode& n) { return std::tuple(n.node, n.bond, n.side); };
  const auto in_order = [&](std::vector<BondNode> nodes) {
    std::ranges::sort(nodes, {}, key);
    nodes.erase(std::ranges::unique(nodes, {}, key).begin(), nodes.end());
    return nodes;
  };
  const auto of_bonds = in_order(answer(nodes_, asked, comm));
  auto round = of_bonds;
  std::vector<SentFaceAtBond> faces;
  std::vector<SentNodeAtBond> nodes;
  for (int ring = 1; ring <= rings_beyond; ++ring) {
    std::vector<BondNode> next;
    for (const auto* surface : surfaces)
      for (std::size_t f = 0; f < surface->faces.size(); ++f) {
        std::vector<std::pair<int, int>> met;
        for (const Local n : surface->faces[f])
          for (const auto& mark :
               std::ranges::equal_range(round, surface->node_id[static_cast<std::size_t>(n)], {}, &BondNode::node))
            met.emplace_back(mark.bond, mark.side);
        std::ranges::sort(met);
        met.erase(std::ranges::unique(met).begin(), met.end());
        for (const auto& [bond, at_side] : met) {
          for (const Local n : surface->faces[f]) {
            const Global node = surface->node_id[static_cast<std::size_t>(n)];
            next.push_back({node, bond, at_side});
            if (ring == rings_beyond)
              nodes.push_back({bond, at_side, pack_node(*surface, static_cast<std::size_t>(n)),
                               std::ranges::binary_search(of_bonds, std::tuple(node, bond, at_side), {}, key) ? 1 : 0});
          }
          if (ring == rings_beyond) faces.push_back({bond, at_side, pack_face(*surface, f)});
        }
      }
    if (ring < rings_beyond) round = in_order(answer(by_node<BondNode>(in_order(std::move(next)), comm), asked, comm));
  }
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
      for (const Global id : moved.faces.node_id) moved.in_bond.push_back(static_cast<char>(in_bond.at(id)));
      if (const auto rotation = rotation_of(pairs[c].options))
        for (auto& x : moved.faces.points)
          x = at_side == 0 ? (*rotation)(x) : Point(rotation->rotation.transpose() * (x - rotation->translation));
      moved.alone = alone_of(moved.faces);
    }
}

std::vector<std::vector<Local>> FacesAtBonds::held_together(const Side& side, const Communicator& comm) const
{
  if (at_bond_.empty()) return {};
  std::map<int, std::vector<Local>> of_bond;
  for (const auto& n : answer(nodes_, ask(side.node_id, comm), comm))
    of_bond[n.bond].push_back(static_cast<Local>(std::ranges::lower_bound(side.node_id, n.node) - side.node_id.begin()));
  std::vector<std::vector<Local>> result;
  for (auto& [bond, nodes] : of_bond) result.push_back(std::move(nodes));
  return result;
}

// Those of a node of the side, each with what comes nearest to its normal beyond.
bool FacesAtBonds::go_on(const Side& side, std::span<const SurfaceNodes> alone, const Corners& corners, const Moved& beyond,
                         const Corners& corners_beyond)
{
  return std::ranges::all_of(corners, [&](const auto& corner) {
    const Point face = side.geometry(corner.first).normal();
    const auto nearest = std::ranges::min_element(corners_beyond, {}, [&](const auto& other) {
      return (beyond.faces.geometry(other.first).normal() - face).norm();
    });
    for (std::size_t i = 0; i < alone.size(); ++i)
      if (goes_on(face, alone[i].normal(side, corner.first, corner.second), beyond.faces.geometry(nearest->first).normal(),
                  beyond.alone[i].normal(beyond.faces, nearest->first, nearest->second)))
        return true;
    return false;
  });
}

void FacesAtBonds::append_to(Side& whole, const Side& side, std::span<const SurfaceNodes> alone, const Communicator& comm) const
{
  if (at_bond_.empty()) return;
  std::map<std::pair<int, int>, std::vector<Local>> at;  // the side's nodes, by bond and side of it
  for (const auto& n : answer(nodes_, ask(side.node_id, comm), comm))
    at[{n.bond, n.side}].push_back(static_cast<Local>(std::ranges::lower_bound(side.node_id, n.node) - side.node_id.begin()));
  if (at.empty()) return;
  const CornersOfNodes corners = corners_of_nodes(side);
  for (const auto& [bond, nodes] : at) {
    const auto& beyond = at_bond_[static_cast<std::size_t>(bond.first)][static_cast<std::size_t>(1 - bond.second)];
    const auto& points = beyond.faces.points;
    const auto edges = shortest_edges(beyond.faces);
    const CornersOfNodes corners_beyond = corners_of_nodes(beyond.faces);
    std::vector<Box> boxes;
    for (const Local n : nodes) {
      const Point& x = side.points[static_cast<std::size_t>(n)];
      boxes.emplace_back(x, x);
    }
    const Tree tree(std::move(boxes));
    std::vector<Local> local(points.size(), -1);
    std::vector<char> common(local.size(), 0);
    for (std::size_t n = 0; n < local.size(); ++n) {
      if (!beyond.in_bond[n]) continue;
      double nearest = same_node_across * edges[n];
      for (const int i : tree.candidates(grown(Box(points[n], points[n]), nearest))) {
        const auto found = static_cast<std::size_t>(nodes[static_cast<std::size_t>(i)]);
        const double distance = (side.points[found] - points[n]).norm();
        if (distance > nearest || !go_on(side, alone, corners[found], beyond, corners_beyond[n])) continue;
        nearest = distance, local[n] = static_cast<Local>(found), common[n] = 1;
      }
    }
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
  }
}

SurfaceNodes find_surface_nodes(const Side& side, const SupportedNodes& supports, const FacesAtBonds& at_bonds,
                                const Communicator& comm)
{
  Side whole;
  whole.kinematics = side.kinematics, whole.points = side.points, whole.facets = side.facets;
  const auto alone = alone_of(side);
  at_bonds.append_to(whole, side, alone, comm);
  SymmetryPlanes planes(side, alone, supports);
  for (auto& plane : planes.all()) {
    find_appended(whole, plane);
    append_image(whole, plane);
  }
  if (whole.facets.size() == side.facets.size()) return of_first(side, alone[0]);
  auto result = of_first(side, surface_nodes_of_facets(whole));
  for (const auto& plane : planes.all()) planes.settle(plane, result);
  return result;
}

}  // namespace mortise::contact
