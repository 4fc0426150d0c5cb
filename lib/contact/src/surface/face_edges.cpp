#include "surface/face_edges.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "pairing/skin.hpp"

namespace mortise::contact {

FaceEdges::FaceEdges(const Side& side) : side_(side), faces_(side.faces.size())
{
  for (std::size_t f = 0; f < faces_.size(); ++f) faces_[f] = corners_of_face(f);
  find_edges();
  turns_.reserve(edges_.size());
  for (const Edge& edge : edges_) {
    turns_.push_back(turn_at(edge));
    corners_.push_back((faces_[edge.faces[0]].normal - faces_[edge.faces[1]].normal).norm());
  }
}

FaceEdges::Face FaceEdges::corners_of_face(std::size_t f) const
{
  Face face;
  const auto corners = static_cast<std::size_t>(mesh::corner_count(side_.faces.type[f]));
  face.geometry.type = corners == 2 ? mesh::CellType::line2 : corners == 3 ? mesh::CellType::tri3 : mesh::CellType::quad4;
  for (std::size_t k = 0; k < corners; ++k) {
    face.nodes.push_back(side_.faces[f][k]);
    face.geometry.nodes.push_back(at(side_.faces[f][k]));
  }
  face.centre = face.geometry.centre();
  face.normal = face.geometry.normal();
  return face;
}

void FaceEdges::find_edges()
{
  std::vector<std::tuple<Local, Local, std::size_t>> all;
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    const auto& nodes = faces_[f].nodes;
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      const Local a = nodes[k], b = nodes.size() == 2 ? a : nodes[(k + 1) % nodes.size()];
      all.emplace_back(std::min(a, b), std::max(a, b), f);
    }
  }
  std::sort(all.begin(), all.end());
  for (std::size_t begin = 0, end = 0; begin < all.size(); begin = end) {
    const auto [a, b, first] = all[begin];
    while (end < all.size() && std::get<0>(all[end]) == a && std::get<1>(all[end]) == b) ++end;
    const std::size_t last = std::get<2>(all[end - 1]);
    if (end != begin + 2 || faces_[first].normal.dot(faces_[last].normal) < kink) continue;
    faces_[first].beside.push_back({last, edges_.size()});
    faces_[last].beside.push_back({first, edges_.size()});
    edges_.push_back({a, b, {first, last}});
  }
}

FaceEdges::Frame FaceEdges::frame_of(const Edge& edge) const
{
  const Face &first = faces_[edge.faces[0]], &last = faces_[edge.faces[1]];
  return frame_between(edge.a, edge.b, first.normal + last.normal, last.centre - first.centre);
}

FaceEdges::Frame FaceEdges::frame_between(Local a, Local b, const Point& normal, const Point& away) const
{
  Frame frame{(at(a) + at(b)) / 2, normal.normalized(), Point::Zero(), Point::Zero(), 0};
  if (a != b) {
    frame.along = (at(b) - at(a)).normalized();
    frame.half = (at(b) - at(a)).norm() / 2;
  }
  frame.away = (away - away.dot(frame.normal) * frame.normal - away.dot(frame.along) * frame.along).normalized();
  return frame;
}

double FaceEdges::depth(std::size_t face, const Frame& frame, const Point& away) const
{
  double result = 0;
  for (const Local n : faces_[face].nodes) result = std::max(result, (at(n) - frame.middle).dot(away));
  return result;
}

// As a line of second order through its nodes does.
std::optional<Point> FaceEdges::leaves(std::size_t face, Local from, Local to) const
{
  const auto nodes = side_.faces[face];
  const auto& middles = mesh::middles(side_.faces.type[face]);
  for (std::size_t m = 0; m < middles.size(); ++m) {
    if (middles[m].size() != 2) continue;
    const Local a = nodes[static_cast<std::size_t>(middles[m][0])], b = nodes[static_cast<std::size_t>(middles[m][1])];
    if ((a == from && b == to) || (a == to && b == from))
      return Point(4 * at(nodes[faces_[face].nodes.size() + m]) - 3 * at(from) - at(to));
  }
  return std::nullopt;
}

std::optional<double> FaceEdges::slope_of_curved(std::size_t face, Local a, Local b, const Frame& frame) const
{
  const auto& nodes = faces_[face].nodes;
  const std::size_t n = nodes.size();
  double sum = 0;
  for (const auto& [from, other] : {std::pair(a, b), std::pair(b, a)}) {
    const auto k = static_cast<std::size_t>(std::find(nodes.begin(), nodes.end(), from) - nodes.begin());
    const Local after = nodes[(k + 1) % n], across = after == other ? nodes[(k + n - 1) % n] : after;
    const auto line = leaves(face, from, across);
    if (!line) return std::nullopt;
    double rise = line->dot(frame.normal);
    if (from != other) {
      const auto along = leaves(face, from, other);
      if (!along) return std::nullopt;
      rise -= line->dot(frame.along) * along->dot(frame.normal) / along->dot(frame.along);
    }
    sum += rise / std::abs(line->dot(frame.away));
  }
  return sum / 2;
}

std::optional<double> FaceEdges::turn_at(const Edge& edge) const
{
  const Frame frame = frame_of(edge);
  const auto first = slope_of_curved(edge.faces[0], edge.a, edge.b, frame);
  const auto last = slope_of_curved(edge.faces[1], edge.a, edge.b, frame);
  return first && last ? std::optional(*first + *last) : std::nullopt;
}

FaceEdges::Around FaceEdges::around(std::size_t face, Local a, Local b, const Frame& frame, const std::vector<bool>& parted) const
{
  constexpr double far = 0.75, behind = 1.4;  // edges across the way are, over how far the face reaches
  Around result;
  const Point away = (faces_[face].centre - frame.middle).dot(frame.away) > 0 ? frame.away : Point(-frame.away);
  const double reach = depth(face, frame, away);
  const auto is_at_edge = [&](const Edge& edge) { return edge.a == a && edge.b == b; };
  const auto touches_edge = [&](const Edge& edge) { return edge.has(a) || edge.has(b); };
  const std::size_t rings_of_a_row = faces_[face].nodes.size() == 3 ? 2 : 1;  // two triangles reach as far as a quadrangle
  std::vector<std::size_t> seen{face};
  for (std::size_t first = 0, ring = 0; ring < 2 * rings_of_a_row; ++ring) {
    const bool next = ring < rings_of_a_row;
    const std::size_t last = seen.size();
    for (; first < last; ++first)
      for (const auto& [other, e] : faces_[seen[first]].beside) {
        if (is_at_edge(edges_[e]) || (ring > 0 && touches_edge(edges_[e])) || (!parted.empty() && parted[e])) continue;
        if (std::find(seen.begin(), seen.end(), other) == seen.end()) seen.push_back(other);
        const double depth_of_edge = ((at(edges_[e].a) + at(edges_[e].b)) / 2 - frame.middle).dot(away);
        if (next && depth_of_edge > far * reach) result.any_next = true;
        if (!next && depth_of_edge > behind * reach) result.any_beyond = true;
        result.curved = result.curved && turns_[e].has_value();
        double& most = next ? result.next : result.beyond;
        most = std::max(most, std::abs(turns_[e].value_or(0)));
        if (next) result.corners = std::max(result.corners, corners_[e]);
      }
  }
  return result;
}

bool FaceEdges::touch(std::size_t face, std::size_t other) const
{
  const auto& nodes = faces_[other].nodes;
  return std::any_of(faces_[face].nodes.begin(), faces_[face].nodes.end(),
                     [&](Local n) { return std::find(nodes.begin(), nodes.end(), n) != nodes.end(); });
}

Few<FacetEdge, 2> FaceEdges::facet_edges(std::size_t of, Local from, Local to) const
{
  const auto face = side_.faces[of];
  const auto type = side_.faces.type[of];
  const auto corners = static_cast<std::size_t>(mesh::corner_count(type));
  if (from != to)
    for (std::size_t m = corners; m < face.size(); ++m) {
      const auto& ends = mesh::middles(type)[m - corners];
      if (ends.size() != 2) continue;
      const Local a = face[static_cast<std::size_t>(ends[0])], b = face[static_cast<std::size_t>(ends[1])], middle = face[m];
      if (std::minmax(a, b) != std::minmax(from, to)) continue;
      return {{std::min(a, middle), std::max(a, middle)}, {std::min(b, middle), std::max(b, middle)}};
    }
  return {{std::min(from, to), std::max(from, to)}};
}

}  // namespace mortise::contact
