#include "crossing/skin_edges.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace mortise::contact {

namespace {

// Cosine of the angle from which two facets meet at an edge of the body.
constexpr double body_edge = 0.25;
// Sine of the angle with a facet's plane below which a line runs in it.
constexpr double runs_in = 1e-6;

// Where the line from a to b passes through the triangle a corner of which is p, with these two edges [Moller and Trumbore].
void add_passage(const Point& a, const Point& b, const Point& p, const Point& first, const Point& second,
                 std::vector<double>& passages)
{
  const Point way = b - a, across = way.cross(second), normal = first.cross(second);
  const double along = first.dot(across);
  if (!(std::abs(along) > runs_in * way.norm() * normal.norm())) return;
  const Point from = a - p, up = from.cross(first);
  const double u = from.dot(across) / along, v = way.dot(up) / along, t = second.dot(up) / along;
  if (u >= -rounding && v >= -rounding && u + v <= 1 + rounding && t >= -rounding && t <= 1 + rounding)
    passages.push_back(std::clamp(t, 0.0, 1.0));
}

}  // namespace

std::vector<SkinEdge> edges_of(const Skin& skin)
{
  struct OfFacet {
    int body;
    std::array<Local, 2> nodes;
    std::size_t facet;
  };
  std::vector<OfFacet> all;
  for (std::size_t i = 0; i < skin.side.facets.size(); ++i) {
    const auto nodes = skin.side.facets[i];
    const int body = skin.body[at(skin.side.face_of[i])];
    for (std::size_t k = 0; k < (nodes.size() == 2 ? 1 : nodes.size()); ++k) {
      const auto [low, high] = std::minmax(nodes[k], nodes[(k + 1) % nodes.size()]);
      all.push_back({body, {low, high}, i});
    }
  }
  std::sort(all.begin(), all.end(), [](const OfFacet& a, const OfFacet& b) {
    return std::tie(a.body, a.nodes, a.facet) < std::tie(b.body, b.nodes, b.facet);
  });
  std::vector<SkinEdge> edges;
  for (const auto& [body, nodes, facet] : all) {
    if (edges.empty() || edges.back().body != body || edges.back().nodes != nodes) edges.push_back({body, nodes, {}});
    edges.back().facets.push_back(facet);
  }
  return edges;
}

std::vector<double> bulges_of(const std::vector<SkinEdge>& edges, const std::vector<FaceGeometry>& facets,
                              const std::vector<Point>& normals)
{
  std::vector<double> angle(facets.size(), 0.0);
  const auto meet = [&](std::size_t f, std::size_t g) {
    const double cosine = normals[f].dot(normals[g]);
    if (!(cosine > body_edge)) return;
    const double phi = std::acos(std::min(cosine, 1.0));
    angle[f] = std::max(angle[f], phi);
    angle[g] = std::max(angle[g], phi);
  };
  struct AtNode {
    int body;
    Local node;
    std::size_t facet;
  };
  std::vector<AtNode> lines;
  for (const auto& edge : edges) {
    for (std::size_t i = 1; i < edge.facets.size(); ++i) meet(edge.facets[i - 1], edge.facets[i]);
    if (facets[edge.facets.front()].nodes.size() > 2) continue;
    for (const Local n : edge.nodes) lines.push_back({edge.body, n, edge.facets.front()});
  }
  std::sort(lines.begin(), lines.end(), [](const AtNode& a, const AtNode& b) {
    return std::tie(a.body, a.node, a.facet) < std::tie(b.body, b.node, b.facet);
  });
  for (std::size_t i = 1; i < lines.size(); ++i)
    if (lines[i - 1].body == lines[i].body && lines[i - 1].node == lines[i].node) meet(lines[i - 1].facet, lines[i].facet);
  for (std::size_t f = 0; f < facets.size(); ++f) angle[f] = facets[f].size() / 2 * std::tan(angle[f] / 4);
  return angle;
}

void add_passages(const Point& a, const Point& b, const FaceGeometry& facet, std::vector<double>& passages)
{
  const auto& n = facet.nodes;
  if (n.size() == 2) {
    const Point normal(n[1][1] - n[0][1], n[0][0] - n[1][0], 0), way = b - a, line = n[1] - n[0];
    const double along = way.dot(normal);
    if (!(std::abs(along) > runs_in * way.norm() * normal.norm())) return;
    const double t = (n[0] - a).dot(normal) / along, s = (a + t * way - n[0]).dot(line) / line.squaredNorm();
    if (s >= -rounding && s <= 1 + rounding && t >= -rounding && t <= 1 + rounding) passages.push_back(std::clamp(t, 0.0, 1.0));
    return;
  }
  add_passage(a, b, n[0], n[1] - n[0], n[2] - n[0], passages);
  if (n.size() == 4) add_passage(a, b, n[0], n[2] - n[0], n[3] - n[0], passages);
}

}  // namespace mortise::contact
