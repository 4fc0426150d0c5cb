#include "surface/continued_side.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "pairing/skin.hpp"
#include "surface/curved_borders.hpp"

namespace mortise::contact {

namespace {

// A plane that may be one of symmetry, and which points of a side lie in it.
struct SymmetryPlane {
  Point normal;
  double offset;
  std::vector<FacetEdge> border = {};  // edges that may lie in it, or ends of a curve,
  std::vector<GoesOn> said;            // and what their nodes say
  std::vector<char> has = {};
  std::vector<std::size_t> images = {};  // facets of the whole

  double height(const Point& x) const { return normal.dot(x) - offset; }
};

// The planes that a side ends in, and that supports hold it in.
class SymmetryPlanes {
 public:
  SymmetryPlanes(const Side& side, std::span<const SurfaceNodes> alone, const SupportedNodes& supports)
      : side_(side), alone_(alone), supports_(supports), corners_(corners_of_nodes(side))
  {
    for (std::size_t f = 0; f < side.facets.size(); ++f) add_border_of(f);
    if (planes_.empty()) return;
    const CurvedBorders curved(side);
    for (auto& plane : planes_) {
      const auto in_plane = [&](Local n) { return plane.said[static_cast<std::size_t>(n)] != GoesOn::not_asked; };
      for (const auto& edge : curved.edges())
        if (in_plane(edge.a) && in_plane(edge.b) && curved.meets_image_at_kink(edge, plane.normal)) deny(edge.parts, plane.said);
      follow_neighbours(plane.border, plane.said);
      for (const GoesOn said : plane.said) plane.has.push_back(said == GoesOn::yes ? 1 : 0);
    }
    std::erase_if(planes_, [](const SymmetryPlane& plane) { return std::ranges::find(plane.has, 1) == plane.has.end(); });
  }

  std::vector<SymmetryPlane>& all() { return planes_; }

  // Normals lie in a plane where the side goes on in its image; at a kink there they are those of the side alone.
  void project_normals(const SymmetryPlane& plane, const mesh::Cells& facets, SurfaceNodes& of_whole) const
  {
    std::vector<char> goes_on(of_whole.all.size(), 0);
    for (const std::size_t f : plane.images)
      for (std::size_t k = 0; k < facets[f].size(); ++k)
        goes_on[static_cast<std::size_t>(of_whole.of_corner[static_cast<std::size_t>(facets.offset[f]) + k])] = 1;
    for (std::size_t f = 0; f < side_.facets.size(); ++f)
      for (std::size_t k = 0; k < side_.facets[f].size(); ++k) {
        const Local n = side_.facets[f][k];
        const auto p = static_cast<std::size_t>(of_whole.of_corner[static_cast<std::size_t>(side_.facets.offset[f]) + k]);
        auto& node = of_whole.all[p];
        if (plane.has[static_cast<std::size_t>(n)] && goes_on[p]) {
          node.normal = (node.normal - node.normal.dot(plane.normal) * plane.normal).normalized();
        } else if (std::abs(plane.height(at(n))) < rounding * side_.geometry(f).size()) {
          const SurfaceNode& of_side = alone_[0].at(side_, f, k);
          node.normal = of_side.normal, node.third_order = of_side.third_order, node.lean = of_side.lean;
        }
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

  // Directions in which supports prescribe a node.
  std::vector<Point> prescribed_directions(Local n) const
  {
    const Global node = side_.node_id[static_cast<std::size_t>(n)];
    std::vector<Point> result;
    for (int c = 0; c < 3; ++c)
      if (supports_.find(node, c)) result.push_back(Point::Unit(c));
    for (const auto& skew : supports_.skew_supports(node)) result.push_back(along(skew));
    return result;
  }

  // Also by supports that prescribe it in several directions, of which it is none.
  bool is_prescribed(Local n, const Point& direction) const
  {
    Few<Point, 3> basis;
    const auto part_left = [&](Point m) {
      for (const Point& b : basis) m -= m.dot(b) * b;
      return m;
    };
    for (const Point& m : prescribed_directions(n))
      if (const Point left = part_left(m); basis.size() < 3 && left.norm() > rounding) basis.push_back(left.normalized());
    return part_left(direction).norm() < rounding;
  }

  // Faces that meet their images at a sharp edge have no vote.
  GoesOn ask(Local n, const Point& direction) const
  {
    const auto image = [&](const Point& x) { return Point(x - 2 * x.dot(direction) * direction); };
    GoesOn result = GoesOn::yes;
    for (const auto& [f, k] : corners_[static_cast<std::size_t>(n)]) {
      const Point face = side_.geometry(f).normal();
      if (std::abs(face.dot(direction)) >= 0.5) return GoesOn::not_asked;
      if (std::ranges::none_of(alone_, [&](const SurfaceNodes& alone) {
            const Point& normal = alone.normal(side_, f, k);
            return goes_on(face, normal, image(face), image(normal));
          }))
        result = GoesOn::no;
    }
    return result;
  }

  // The edge from a to b, or the end a = b of a curve.
  void add(Local a, Local b)
  {
    const double length = (at(a) - at(b)).norm();
    for (const Local one : {a, b})
      for (const Point& m : prescribed_directions(one)) {
        if (std::abs(m.dot(at(b) - at(a))) > rounding * length || !is_prescribed(one == a ? b : a, m)) continue;
        auto& plane = plane_of(m, a);
        for (const Local n : {a, b}) plane.said[static_cast<std::size_t>(n)] = ask(n, m);
        plane.border.push_back({a, b});
      }
  }

  SymmetryPlane& plane_of(const Point& m, Local n)
  {
    const double size = side_.geometry(corners_[static_cast<std::size_t>(n)][0].first).size();
    for (auto& plane : planes_)
      if (std::abs(plane.normal.dot(m)) > 1 - rounding * rounding && std::abs(plane.height(at(n))) < rounding * size)
        return plane;
    return planes_.emplace_back(
        SymmetryPlane{.normal = m, .offset = m.dot(at(n)), .said = std::vector<GoesOn>(side_.points.size(), GoesOn::not_asked)});
  }

  const Side& side_;
  std::span<const SurfaceNodes> alone_;  // see alone_of()
  const SupportedNodes& supports_;
  std::vector<NodeCorners> corners_;
  std::vector<SymmetryPlane> planes_;
};

// Points that lie in a plane and were appended after it was found.
void find_appended(const Side& side, SymmetryPlane& plane)
{
  const auto edges = shortest_edges(side);
  for (std::size_t n = plane.has.size(); n < side.points.size(); ++n)
    plane.has.push_back(std::abs(plane.height(side.points[n])) < rounding * edges[n] ? 1 : 0);
}

std::vector<Local> in_order(std::span<const Local> nodes)
{
  std::vector<Local> result(nodes.begin(), nodes.end());
  std::ranges::sort(result);
  return result;
}

// Of the facets near the plane, those that are not there yet. `images`: of each point that is none itself the images so far, by
// any planes; `image_of`: of each point that which it is an image of, or itself. Where both parts of a bond are in one side,
// there are points in one place that have nothing to do with each other.
void append_image(Side& side, SymmetryPlane& plane, std::vector<std::vector<Local>>& images, std::vector<Local>& image_of)
{
  const auto edges = shortest_edges(side);
  std::vector<Local> image(side.points.size(), -1);
  const auto find_image = [&](Local n) {
    const auto of = static_cast<std::size_t>(n);
    if (plane.has[of]) return n;
    if (image[of] >= 0) return image[of];
    const Local origin = image_of[of];
    auto& others = images[static_cast<std::size_t>(origin)];
    const Point x = side.points[of], y = x - 2 * plane.height(x) * plane.normal;
    const auto is_there = [&](Local other) {
      return (side.points[static_cast<std::size_t>(other)] - y).norm() < rounding * edges[of];
    };
    if (is_there(origin)) return image[of] = origin;
    if (const auto found = std::ranges::find_if(others, is_there); found != others.end()) return image[of] = *found;
    image[of] = static_cast<Local>(side.points.size());
    others.push_back(image[of]);
    image_of.push_back(origin);
    side.points.push_back(y);
    return image[of];
  };
  std::vector<std::vector<Local>> known;
  for (std::size_t f = 0; f < side.facets.size(); ++f) known.push_back(in_order(side.facets[f]));
  std::ranges::sort(known);
  const auto near = facets_round(side.facets, plane.has);
  std::vector<Local> reversed;
  for (std::size_t f = 0; f < near.size(); ++f) {
    if (!near[f]) continue;
    reversed.assign(side.facets[f].rbegin(), side.facets[f].rend());
    std::ranges::transform(reversed, reversed.begin(), find_image);
    if (std::ranges::binary_search(known, in_order(reversed))) continue;
    plane.images.push_back(side.facets.size());
    side.facets.add(mesh::CellType(side.facets.type[f]), reversed);
  }
  append_kinks(side, side,
               [&](Local n) { return plane.has[static_cast<std::size_t>(n)] ? n : image[static_cast<std::size_t>(n)]; });
}

// The edges of the first facets, `count` of them, that others have as well and that lie on one surface with these.
std::vector<FacetEdge> edges_in_common(const mesh::Cells& facets, std::size_t count, const SurfaceNodes& surface_nodes)
{
  const auto each = [&](std::size_t first, std::size_t last, const auto& use) {
    for (std::size_t f = first; f < last; ++f)
      for (std::size_t k = 0; k < facets[f].size(); ++k) {
        const std::size_t n = facets[f].size(), l = n == 2 ? k : (k + 1) % n;
        const auto at = [&](std::size_t corner) {
          return std::pair(facets[f][corner], surface_nodes.of_corner[static_cast<std::size_t>(facets.offset[f]) + corner]);
        };
        use(std::minmax({at(k), at(l)}));
      }
  };
  std::vector<std::pair<std::pair<Local, Local>, std::pair<Local, Local>>> others;
  each(count, facets.size(), [&](const auto& edge) { others.push_back(edge); });
  std::ranges::sort(others);
  std::vector<FacetEdge> result;
  each(0, count, [&](const auto& edge) {
    if (std::ranges::binary_search(others, std::pair(edge))) result.push_back({edge.first.first, edge.second.first});
  });
  std::ranges::sort(result);
  return result;
}

// The surface nodes of `whole`, whose first points and facets are those of `side`, without what belongs to others alone.
SurfaceNodes of_first(const Side& side, const mesh::Cells& facets, const SurfaceNodes& whole)
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
  result.continued = edges_in_common(facets, side.facets.size(), whole);
  number_nodes_of_faces(side, result);
  return result;
}

}  // namespace

SurfaceNodes find_surface_nodes(const Side& side, const SupportedNodes& supports, const FacesAtBonds& at_bonds,
                                std::span<const FacesAtBonds::AtBond> nodes)
{
  if (supports.empty() && nodes.empty()) return find_surface_nodes(side);
  Side whole;
  whole.kinematics = side.kinematics, whole.points = side.points, whole.facets = side.facets, whole.kinks = side.kinks,
  whole.tangent_edges = side.tangent_edges;
  auto alone = alone_of(side);
  at_bonds.append_to(whole, side, alone, nodes);
  SymmetryPlanes planes(side, alone, supports);
  std::vector<std::vector<Local>> images(whole.points.size());
  std::vector<Local> image_of(whole.points.size());
  std::iota(image_of.begin(), image_of.end(), 0);
  for (int round = 0; round < rings_beyond; ++round)  // a side one face wide lies between two planes
    for (auto& plane : planes.all()) {
      find_appended(whole, plane);
      append_image(whole, plane, images, image_of);
    }
  if (whole.facets.size() == side.facets.size()) {
    number_nodes_of_faces(side, alone[0]);
    return std::move(alone[0]);
  }
  auto of_whole = surface_nodes_of_facets(whole);
  for (const auto& plane : planes.all()) planes.project_normals(plane, whole.facets, of_whole);
  return of_first(side, whole.facets, of_whole);
}

}  // namespace mortise::contact
