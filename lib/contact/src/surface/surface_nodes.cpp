#include "surface/surface_nodes.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include "base/dense.hpp"
#include "pairing/skin.hpp"
#include "surface/arc_normals.hpp"
#include "surface/fitted_normals.hpp"

namespace mortise::contact {

namespace {

// Nelson Max's weight times normal at corner k of a face.
Point corner_normal(const FaceGeometry& face, std::size_t k)
{
  const auto n = face.nodes.size();
  if (face.type == mesh::CellType::line2) return face.normal() / face.area();
  const Point next = face.nodes[(k + 1) % n] - face.nodes[k], last = face.nodes[(k + n - 1) % n] - face.nodes[k];
  return next.cross(last) / (next.squaredNorm() * last.squaredNorm());
}

// An edge from surface node to surface node and how many faces have it. Every edge stands there both ways.
struct Edge {
  Local from, to;
  int count;
};

// Ascending.
std::vector<Edge> edges_of(const Side& side, const SurfaceNodes& surface_nodes)
{
  std::vector<std::pair<Local, Local>> all;
  all.reserve(2 * side.facets.nodes.size());
  for (std::size_t f = 0; f < side.facets.size(); ++f) {
    const auto begin = static_cast<std::size_t>(side.facets.offset[f]), n = side.facets[f].size();
    for (std::size_t k = 0; k < n; ++k) {
      if (n == 2 && k == 1) continue;
      const Local a = surface_nodes.of_corner[begin + k], b = surface_nodes.of_corner[begin + (k + 1) % n];
      all.emplace_back(a, b);
      all.emplace_back(b, a);
    }
  }
  std::sort(all.begin(), all.end());
  std::vector<Edge> edges;
  for (const auto& [from, to] : all) {
    if (edges.empty() || edges.back().from != from || edges.back().to != to) edges.push_back({from, to, 0});
    ++edges.back().count;
  }
  return edges;
}

// Whether each surface node is on a border. Where a kink ends inside a surface its two sides are none: they lead to one node.
std::vector<bool> nodes_on_border(const SurfaceNodes& surface_nodes, const std::vector<Edge>& edges)
{
  std::vector<bool> border(surface_nodes.all.size(), false);
  const auto end = [&](const Edge& edge) { return surface_nodes.all[static_cast<std::size_t>(edge.to)].node; };
  std::vector<Local> ends;
  for (std::size_t first = 0, last = 0; first < edges.size(); first = last) {
    ends.clear();
    for (; last < edges.size() && edges[last].from == edges[first].from; ++last)
      if (edges[last].count == 1) ends.push_back(end(edges[last]));
    std::sort(ends.begin(), ends.end());
    for (std::size_t e = 0; e < ends.size(); ++e) {
      const bool twice = (e > 0 && ends[e - 1] == ends[e]) || (e + 1 < ends.size() && ends[e + 1] == ends[e]);
      if (!twice) border[static_cast<std::size_t>(edges[first].from)] = true;
    }
  }
  return border;
}

// Where the border goes on nearly straight, its two edges turning by less than 45 degrees, its direction; 0 elsewhere.
std::vector<Point> directions_of_border(const Side& side, const SurfaceNodes& surface_nodes, const std::vector<Edge>& edges)
{
  std::vector<Few<Point, 2>> along(surface_nodes.all.size());
  std::vector<int> ends(surface_nodes.all.size(), 0);
  const auto at = [&](Local surface_node) -> const Point& {
    return side.points[static_cast<std::size_t>(surface_nodes.all[static_cast<std::size_t>(surface_node)].node)];
  };
  for (const auto& [from, to, count] : edges)
    if (count == 1 && ++ends[static_cast<std::size_t>(from)] <= 2)
      along[static_cast<std::size_t>(from)].push_back((at(to) - at(from)).normalized());
  std::vector<Point> result(surface_nodes.all.size(), Point::Zero());
  for (std::size_t p = 0; p < ends.size(); ++p)
    if (ends[p] == 2 && along[p][0].dot(along[p][1]) < -0.7) result[p] = (along[p][0] - along[p][1]).normalized();
  return result;
}

// Turns the normal at the start of lines so that it has the opposite slopes of the normals at their ends, in the least squares.
// Where a border goes on in a direction, it turns across that alone: along it the faces on both sides have said what there is to
// say. Whether it did.
bool continue_along(std::span<const std::pair<Point, Local>> lines, const Point& direction, const SurfaceNodes& ends,
                    Point& normal)
{
  constexpr double beside = 0.1, held = 1e-6;
  const bool corner = direction.isZero(0);
  const Point across = corner ? Point(Point::Zero()) : Point(normal.cross(direction).normalized());
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Point right = Point::Zero();
  for (const auto& [line, end] : lines) {
    const double length = line.norm();
    const Point along = line / length;
    const double part = across.dot(along);
    if (!corner && std::abs(part) < beside) continue;
    const Point turns = (corner ? along : Point(part * across)) / length;
    matrix += turns * turns.transpose();
    right -= (normal + ends.all[static_cast<std::size_t>(end)].normal).dot(along) / length * turns;
  }
  if (matrix.isZero(0)) return false;
  matrix += held * matrix.trace() * Eigen::Matrix3d::Identity();
  normal = (normal + Point(dense::solve_symmetric(matrix, right))).normalized();
  return true;
}

// Corrects the normals of surface nodes on a border, see find_surface_nodes(), and tells which these are.
std::vector<bool> continue_curvature(const Side& side, SurfaceNodes& surface_nodes)
{
  const auto edges = edges_of(side, surface_nodes);
  const bool plane = side.facets.size() > 0 && side.facets.type[0] == mesh::CellType::line2;
  std::vector<bool> border(surface_nodes.all.size(), false);
  if (plane) {
    std::vector<int> degree(border.size(), 0);
    for (const auto& edge : edges) ++degree[static_cast<std::size_t>(edge.from)];
    for (std::size_t p = 0; p < border.size(); ++p) border[p] = degree[p] < 2;
  } else {
    border = nodes_on_border(surface_nodes, edges);
  }

  // First from edges that lead inside; then corners, whose normal is wrong both ways, from all their neighbours; last those that
  // have corners alone round them, as the tips of a border of teeth. On a surface one cell wide all surface nodes are on the
  // border: there those between two faces have the normal that the ends continue.
  const auto direction =
      plane ? std::vector<Point>(border.size(), Point::Zero()) : directions_of_border(side, surface_nodes, edges);
  const auto smooth = [&](std::size_t p) { return !direction[p].isZero(0); };
  std::vector<bool> known(border.size());
  for (std::size_t p = 0; p < border.size(); ++p) known[p] = !border[p];
  const auto at = [&](std::size_t p) -> const Point& { return side.points[static_cast<std::size_t>(surface_nodes.all[p].node)]; };
  std::vector<Edge> outer;  // those that start on a border
  std::copy_if(edges.begin(), edges.end(), std::back_inserter(outer), [&](const Edge& edge) {
    const bool along_kink = !plane && edge.count == 1 && !border[static_cast<std::size_t>(edge.to)];  // to where it ends
    return border[static_cast<std::size_t>(edge.from)] && !along_kink;
  });
  for (int pass = 0; pass < 3; ++pass) {
    std::vector<bool> reached = known;
    const auto leads = [&](std::size_t b, std::size_t a) {
      if (pass == 1) return known[b] || (smooth(b) && !smooth(a));
      return known[b] && (pass == 0 ? plane || smooth(a) : !smooth(a));
    };
    std::vector<std::pair<Point, Local>> lines;  // from a surface node to others
    for (int sweep = 0; sweep < 10; ++sweep)
      for (std::size_t first = 0, last = 0; first < outer.size(); first = last) {
        const auto a = static_cast<std::size_t>(outer[first].from);
        lines.clear();
        for (; last < outer.size() && outer[last].from == outer[first].from; ++last)
          if (const auto b = static_cast<std::size_t>(outer[last].to); !known[a] && leads(b, a))
            lines.emplace_back(at(b) - at(a), outer[last].to);
        if (lines.empty()) continue;
        auto& normal = surface_nodes.all[a].normal;
        reached[a] = continue_along(lines, direction[a], surface_nodes, normal) || reached[a];
      }
    known = reached;
  }
  return border;
}

// Where a plane runs into an arc, the normal is the plane's, and where straight lines do, it is normal to them: a surface over
// both would be tilted by up to half of the angle between the faces. Where two planes do, or lines that differ, it is left.
void take_normals_of_straight(const Side& side, SurfaceNodes& surface_nodes)
{
  if (side.tangent_edges.empty()) return;
  auto tangent = side.tangent_edges;
  std::sort(tangent.begin(), tangent.end());
  const auto at = [&](Local n) -> const Point& { return side.points[static_cast<std::size_t>(n)]; };
  struct Straight {
    Local surface_node;
    bool line;
    Point direction;  // of the line, or the normal of the plane
  };
  std::vector<Straight> found;
  const auto add = [&](std::size_t corner, Local node, const TangentEdge& edge) {
    const auto& [first, last] = edge.beyond;
    const auto along = [&](const std::array<Local, 2>& line) { return Point((at(line[1]) - at(line[0])).normalized()); };
    Point direction = node == first[0] ? along(first) : node == last[0] ? along(last) : Point(along(first) + along(last));
    if (edge.plane) {
      const auto [a, b] = edge.edge;
      direction = (a == b ? Point(Point::UnitZ()) : Point(at(b) - at(a))).cross(along(first));
    }
    const Local p = surface_nodes.of_corner[corner];
    const bool turned = edge.plane && direction.dot(surface_nodes.all[static_cast<std::size_t>(p)].normal) < 0;
    found.push_back({p, !edge.plane, (turned ? -1 : 1) * direction.normalized()});
  };
  for (std::size_t f = 0; f < side.facets.size(); ++f) {
    const auto nodes = side.facets[f];
    const auto begin = static_cast<std::size_t>(side.facets.offset[f]), n = nodes.size();
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t next = n == 2 ? k : (k + 1) % n;
      const FacetEdge edge{std::min(nodes[k], nodes[next]), std::max(nodes[k], nodes[next])};
      const auto [first, last] = std::ranges::equal_range(tangent, edge, {}, &TangentEdge::edge);
      for (auto e = first; e != last; ++e) {
        add(begin + k, nodes[k], *e);
        if (next != k) add(begin + next, nodes[next], *e);
      }
    }
  }
  // Planes before lines.
  std::ranges::stable_sort(found, {}, [](const Straight& s) { return std::pair(s.surface_node, s.line); });
  for (auto first = found.begin(), last = first; first != found.end(); first = last) {
    last = std::find_if(first, found.end(), [&](const auto& other) { return other.surface_node != first->surface_node; });
    const auto end = std::find_if(first, last, [&](const auto& other) { return other.line != first->line; });
    const Point& direction = first->direction;
    if (!std::all_of(first, end, [&](const auto& other) { return (other.direction - direction).norm() < rounding; })) continue;
    auto& node = surface_nodes.all[static_cast<std::size_t>(first->surface_node)];
    const Point straight = first->line ? Point((node.normal - node.normal.dot(direction) * direction).normalized()) : direction;
    node = {node.node, straight};
  }
}

// Of each node the other ends of the kinks there; of a plane model the node itself.
std::vector<std::pair<Local, Local>> both_ways(const std::vector<FacetEdge>& kinks)
{
  std::vector<std::pair<Local, Local>> result;
  for (const auto& [a, b] : kinks) {
    result.emplace_back(a, b);
    if (a != b) result.emplace_back(b, a);
  }
  std::sort(result.begin(), result.end());
  return result;
}

// Whether two facets have an edge at a node, given as their corners there, that is none of `kinks`, as of both_ways().
bool share_edge(std::span<const Local> facet, std::size_t k, std::span<const Local> other, std::size_t l,
                std::span<const std::pair<Local, Local>> kinks)
{
  const auto ends = [](std::span<const Local> nodes, std::size_t at) {
    const std::size_t n = nodes.size();
    return n == 2 ? std::array{nodes[at], nodes[at]} : std::array{nodes[(at + 1) % n], nodes[(at + n - 1) % n]};
  };
  const auto is_kink = [&](Local end) {
    return std::any_of(kinks.begin(), kinks.end(), [&](const auto& edge) { return edge.second == end; });
  };
  for (const Local a : ends(facet, k))
    for (const Local b : ends(other, l))
      if (a == b && !is_kink(a)) return true;
  return false;
}

// The corners of facets round each node, in the order of the facets, and the normals there.
struct CornersRoundNodes {
  std::vector<std::size_t> offset, corner;
  std::vector<Local> facet;     // of each corner
  std::vector<Point> normal;    // of each facet
  std::vector<Point> weighted;  // of each corner: the normal times its weight

  explicit CornersRoundNodes(const Side& side);
  std::span<const std::size_t> round(std::size_t node) const
  {
    return {corner.data() + offset[node], offset[node + 1] - offset[node]};
  }
};

CornersRoundNodes::CornersRoundNodes(const Side& side)
    : offset(side.points.size() + 1, 0),
      corner(side.facets.nodes.size()),
      facet(corner.size()),
      normal(side.facets.size()),
      weighted(corner.size())
{
  for (const Local n : side.facets.nodes) ++offset[static_cast<std::size_t>(n) + 1];
  for (std::size_t n = 0; n + 1 < offset.size(); ++n) offset[n + 1] += offset[n];
  auto next = offset;
  for (std::size_t f = 0; f < side.facets.size(); ++f) {
    const auto face = side.geometry(f);
    normal[f] = face.normal();
    for (std::size_t k = 0; k < face.nodes.size(); ++k) {
      const auto c = static_cast<std::size_t>(side.facets.offset[f]) + k;
      weighted[c] = corner_normal(face, k);
      facet[c] = static_cast<Local>(f);
      corner[next[static_cast<std::size_t>(side.facets.nodes[c])]++] = c;
    }
  }
}

// group[i] becomes the smallest of those that hang together with i, of `count` things of which `together` tells by twos.
template <class Together>
void join_groups(std::size_t count, const Together& together, std::vector<std::size_t>& group)
{
  group.resize(count);
  std::iota(group.begin(), group.end(), 0U);
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t a = 0; a < count; ++a)
      for (std::size_t b = 0; b < a; ++b)
        if (group[a] != group[b] && together(a, b)) {
          group[a] = group[b] = std::min(group[a], group[b]);
          changed = true;
        }
  }
}

// A surface node of each group of facets round a node between which there is no kink, with the mean of their normals.
SurfaceNodes nodes_between_kinks(const Side& side)
{
  const CornersRoundNodes corners_round(side);
  const auto kinks_of_nodes = both_ways(side.kinks);
  SurfaceNodes surface_nodes;
  surface_nodes.of_corner.resize(corners_round.corner.size());
  std::vector<std::size_t> group;
  for (std::size_t n = 0; n < side.points.size(); ++n) {
    const auto corners = corners_round.round(n);
    const auto facet_at = [&](std::size_t a) { return static_cast<std::size_t>(corners_round.facet[corners[a]]); };
    const auto normal_at = [&](std::size_t a) -> const Point& { return corners_round.normal[facet_at(a)]; };
    const std::span kinks = std::ranges::equal_range(kinks_of_nodes, static_cast<Local>(n), {}, &std::pair<Local, Local>::first);
    const auto together = [&](std::size_t a, std::size_t b) {
      if (normal_at(a).dot(normal_at(b)) <= kink) return false;
      if (kinks.empty()) return true;
      const auto f = facet_at(a), g = facet_at(b);
      return share_edge(side.facets[f], corners[a] - static_cast<std::size_t>(side.facets.offset[f]), side.facets[g],
                        corners[b] - static_cast<std::size_t>(side.facets.offset[g]), kinks);
    };
    join_groups(corners.size(), together, group);
    for (std::size_t g = 0; g < corners.size(); ++g) {
      Point normal = Point::Zero();
      for (std::size_t a = 0; a < corners.size(); ++a) {
        if (group[a] != g) continue;
        normal += corners_round.weighted[corners[a]];
        surface_nodes.of_corner[corners[a]] = static_cast<Local>(surface_nodes.all.size());
      }
      if (normal.squaredNorm() > 0) surface_nodes.all.push_back({static_cast<Local>(n), normal.normalized()});
    }
  }
  return surface_nodes;
}

}  // namespace

SurfaceNodes surface_nodes_of_facets(const Side& side, bool fitted)
{
  const SurfaceNodes means = nodes_between_kinks(side);
  SurfaceNodes surface_nodes = means;
  take_normals_between_arcs(side, surface_nodes);
  take_normals_of_straight(side, surface_nodes);
  const auto border = continue_curvature(side, surface_nodes);
  if (fitted && side.kinematics == fem::Kinematics::solid) fit_normals(side, means, border, surface_nodes);
  take_normals_of_straight(side, surface_nodes);
  return surface_nodes;
}

void number_nodes_of_faces(const Side& side, SurfaceNodes& surface_nodes)
{
  surface_nodes.of_node.resize(side.faces.nodes.size());
  for (std::size_t f = 0; f < side.facets.size(); ++f)
    for (std::size_t k = 0; k < side.facets[f].size(); ++k)
      surface_nodes
          .of_node[static_cast<std::size_t>(side.faces.offset[static_cast<std::size_t>(side.face_of[f])] + side.corners[f][k])] =
          surface_nodes.of_corner[static_cast<std::size_t>(side.facets.offset[f]) + k];
}

SurfaceNodes find_surface_nodes(const Side& side)
{
  auto surface_nodes = surface_nodes_of_facets(side);
  number_nodes_of_faces(side, surface_nodes);
  return surface_nodes;
}

}  // namespace mortise::contact
