#include "surface/face_edges.hpp"

#include <algorithm>
#include <tuple>

#include "pairing/skin.hpp"

namespace mortise::contact {

FaceEdges::FaceEdges(const Side& side) : side_(side), faces_(side.faces.size())
{
  for (std::size_t f = 0; f < faces_.size(); ++f) faces_[f] = corners_of_face(f);
  find_edges();
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

FaceEdges::Place FaceEdges::place_of(const Edge& edge) const
{
  const Face &first = faces_[edge.faces[0]], &last = faces_[edge.faces[1]];
  Place place{(at(edge.a) + at(edge.b)) / 2, (first.normal + last.normal).normalized(), Point::Zero(), Point::Zero(), 0};
  if (edge.a != edge.b) {
    place.along = (at(edge.b) - at(edge.a)).normalized();
    place.half = (at(edge.b) - at(edge.a)).norm() / 2;
  }
  const Point between = last.centre - first.centre;
  place.away = (between - between.dot(place.normal) * place.normal - between.dot(place.along) * place.along).normalized();
  return place;
}

double FaceEdges::depth(std::size_t face, const Place& place, const Point& away) const
{
  double result = 0;
  for (const Local n : faces_[face].nodes) result = std::max(result, (at(n) - place.middle).dot(away));
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

std::optional<double> FaceEdges::turn_of_curved(const Edge& edge, const Place& place) const
{
  double sum = 0;
  int ends = 0;
  for (const auto& [from, other] : {std::pair(edge.a, edge.b), std::pair(edge.b, edge.a)}) {
    if (ends == 1 && from == other) break;
    ++ends;
    for (const std::size_t f : edge.faces) {
      const auto& nodes = faces_[f].nodes;
      const std::size_t n = nodes.size(),
                        k = static_cast<std::size_t>(std::find(nodes.begin(), nodes.end(), from) - nodes.begin());
      const Local after = nodes[(k + 1) % n], across = after == other ? nodes[(k + n - 1) % n] : after;
      const auto line = leaves(f, from, across);
      if (!line) return std::nullopt;
      double rise = line->dot(place.normal);
      if (from != other) {
        const auto along = leaves(f, from, other);
        if (!along) return std::nullopt;
        rise -= line->dot(place.along) * along->dot(place.normal) / along->dot(place.along);
      }
      sum += rise / std::abs(line->dot(place.away));
    }
  }
  return sum / ends;
}

bool FaceEdges::touch(std::size_t face, std::size_t other) const
{
  const auto& nodes = faces_[other].nodes;
  return std::any_of(faces_[face].nodes.begin(), faces_[face].nodes.end(),
                     [&](Local n) { return std::find(nodes.begin(), nodes.end(), n) != nodes.end(); });
}

Few<FacetEdge, 2> FaceEdges::facet_edges(const Edge& edge) const
{
  const auto face = side_.faces[edge.faces[0]];
  const auto type = side_.faces.type[edge.faces[0]];
  const auto corners = static_cast<std::size_t>(mesh::corner_count(type));
  if (edge.a != edge.b)
    for (std::size_t m = corners; m < face.size(); ++m) {
      const auto& ends = mesh::middles(type)[m - corners];
      if (ends.size() != 2) continue;
      const Local a = face[static_cast<std::size_t>(ends[0])], b = face[static_cast<std::size_t>(ends[1])], middle = face[m];
      if (std::minmax(a, b) != std::pair<const Local&, const Local&>(edge.a, edge.b)) continue;
      return {{std::min(a, middle), std::max(a, middle)}, {std::min(b, middle), std::max(b, middle)}};
    }
  return {{edge.a, edge.b}};
}

}  // namespace mortise::contact
