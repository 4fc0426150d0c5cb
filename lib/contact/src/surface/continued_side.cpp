#include "surface/continued_side.hpp"

#include <algorithm>
#include <cmath>

#include "pairing/skin.hpp"

namespace mortise::contact {

namespace {

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
        auto& normal =
            of_whole.all[static_cast<std::size_t>(of_whole.of_corner[static_cast<std::size_t>(side_.facets.offset[f]) + k])]
                .normal;
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
      if (std::abs(plane.normal.dot(m)) > 1 - rounding * rounding && std::abs(plane.height(at(n))) < rounding * size)
        return plane;
    return planes_.emplace_back(m, m.dot(at(n)), std::vector<char>(side_.points.size(), 0));
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
  append_kinks(side, side, [&](Local n) {
    const auto node = static_cast<std::size_t>(n);
    return plane.has[node] ? n : image[node];
  });
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
  for (std::size_t c = side.facets.nodes.size(); c < whole.of_corner.size(); ++c)
    if (const Local p = kept[static_cast<std::size_t>(whole.of_corner[c])]; p >= 0)
      result.all[static_cast<std::size_t>(p)].continued = true;
  for (std::size_t c = 0; c < side.facets.nodes.size(); ++c)
    result.of_corner.push_back(kept[static_cast<std::size_t>(whole.of_corner[c])]);
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
  for (auto& plane : planes.all()) {
    find_appended(whole, plane);
    append_image(whole, plane);
  }
  if (whole.facets.size() == side.facets.size()) {
    number_nodes_of_faces(side, alone[0]);
    return std::move(alone[0]);
  }
  auto result = of_first(side, surface_nodes_of_facets(whole));
  for (const auto& plane : planes.all()) planes.settle(plane, result);
  return result;
}

}  // namespace mortise::contact
