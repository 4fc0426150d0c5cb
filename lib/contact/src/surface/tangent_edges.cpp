#include "surface/tangent_edges.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "pairing/skin.hpp"

namespace mortise::contact {

namespace {

class TangentEdges {
 public:
  TangentEdges(const FaceEdges& all, const std::vector<bool>& parted)
      : all_(all), faces_(all.faces()), edges_(all.edges()), parted_(parted)
  {
  }

  std::vector<TangentEdge> find() const
  {
    std::vector<TangentEdge> result;
    for (std::size_t e = 0; e < edges_.size(); ++e)
      if (const auto straight = parted_[e] ? std::nullopt : straight_beyond(edges_[e]))
        for (const FacetEdge& edge : all_.facet_edges(edges_[e])) result.push_back({edge, straight->plane, straight->lines});
    std::sort(result.begin(), result.end());
    return result;
  }

 private:
  using Edge = FaceEdges::Edge;
  using Face = FaceEdges::Face;
  using Frame = FaceEdges::Frame;

  // Faces reach so far from an edge, over what the one at the edge does, where there are two rows of them.
  static constexpr double two_rows = 1.5;
  // Of the angle between two faces of an arc: others differ by no more.
  static constexpr double same_turn = 0.05;
  // From face to face of an arc over that from a plane to it: twice as much, about.
  static constexpr double larger_turn = 1.5;

  struct Straight {
    bool plane;
    TangentEdge::Lines lines;
  };

  // What is straight on one side of an edge and not on the other; a plane rather than lines.
  std::optional<Straight> straight_beyond(const Edge& edge) const
  {
    const auto [first, last] = edge.faces;
    if (coplanar(first, last)) return std::nullopt;
    const Frame frame = all_.frame_of(edge);
    auto back = two_rows_beyond(first, edge, frame, -frame.away), forth = two_rows_beyond(last, edge, frame, frame.away);
    if (!back && !forth) back = before_arc(first, last, edge), forth = before_arc(last, first, edge);
    if (back && forth && back->plane != forth->plane) return back->plane ? back : forth;
    if (back.has_value() == forth.has_value()) return std::nullopt;
    return back ? back : forth;
  }

  bool coplanar(std::size_t f, std::size_t g) const { return (faces_[f].normal - faces_[g].normal).norm() < rounding; }

  // Where a face goes on to a second row away from an edge of its own, through faces of its plane that share nodes with it.
  std::optional<Straight> two_rows_beyond(std::size_t own, const Edge& edge, const Frame& frame, const Point& away) const
  {
    std::vector<std::size_t> flat{own};
    double farthest = 0;
    for (std::size_t i = 0; i < flat.size(); ++i) {
      farthest = std::max(farthest, all_.depth(flat[i], frame, away));
      for (const auto& [f, e] : faces_[flat[i]].beside)
        if (!parted_[e] && coplanar(own, f) && all_.touch(f, own) && std::find(flat.begin(), flat.end(), f) == flat.end())
          flat.push_back(f);
    }
    if (!(farthest > two_rows * all_.depth(own, frame, away)) || between_bends(own, edge)) return std::nullopt;
    return faces_[own].nodes.size() == 2 || is_wide(flat) ? in_plane(own, edge) : along_strip(flat, edge);
  }

  // Whether two faces are in a plane because the curve bends one way before them and the other way after them: it turns no more
  // from what comes before to the next face there, as it does on an arc that a plane runs into.
  bool between_bends(std::size_t own, const Edge& edge) const
  {
    const std::size_t before = edge.faces[edge.faces[0] == own ? 1 : 0];
    const auto second = faces_[own].nodes.size() == 3 ? std::nullopt : next_beyond(own, edge);
    const auto after = second ? next_beyond(second->first, edges_[second->second]) : std::nullopt;
    if (!after || !((faces_[before].normal - faces_[own].normal).dot(faces_[after->first].normal - faces_[own].normal) > 0))
      return false;
    const auto next = next_beyond(before, edge);
    return !next || angle(before, next->first) < larger_turn * angle(own, before);
  }

  // The last face before an arc, which starts at an edge of it: three faces of a circle turn by the same angle, and the plane by
  // half of it. This tells planes of a single row. Triangles scatter too much.
  std::optional<Straight> before_arc(std::size_t last, std::size_t arc, const Edge& edge) const
  {
    if (faces_[arc].nodes.size() == 3 || !goes_on_along(last, edge)) return std::nullopt;
    const auto second = next_beyond(arc, edge);
    if (!second) return std::nullopt;
    const auto third = next_beyond(second->first, edges_[second->second]);
    if (!third) return std::nullopt;
    const double whole = angle(arc, second->first);
    if (!(std::abs(angle(second->first, third->first) - whole) < same_turn * whole) ||
        !(std::abs(angle(last, arc) - whole / 2) < same_turn * whole) ||
        !((faces_[arc].normal - faces_[last].normal).dot(faces_[second->first].normal - faces_[arc].normal) > 0))
      return std::nullopt;
    return in_plane(last, edge);
  }

  double angle(std::size_t f, std::size_t g) const { return 2 * std::asin((faces_[f].normal - faces_[g].normal).norm() / 2); }

  // The face on the other side of one with two or four nodes than an edge, and the edge to it.
  std::optional<std::pair<std::size_t, std::size_t>> next_beyond(std::size_t face, const Edge& edge) const
  {
    for (const auto& [f, e] : faces_[face].beside)
      if (!parted_[e] && !edges_[e].has(edge.a) && !edges_[e].has(edge.b)) return std::pair(f, e);
    return std::nullopt;
  }

  // Whether there is another face of its plane beside it at the same line, as a cylinder has none; in plane models always.
  bool goes_on_along(std::size_t face, const Edge& edge) const
  {
    return edge.a == edge.b || std::any_of(faces_[face].beside.begin(), faces_[face].beside.end(), [&](const auto& beside) {
             const Edge& other = edges_[beside.second];
             return (other.has(edge.a) || other.has(edge.b)) && !parted_[beside.second] && coplanar(face, beside.first);
           });
  }

  Straight in_plane(std::size_t face, const Edge& edge) const
  {
    const auto& nodes = faces_[face].nodes;
    const Local inside = *std::find_if(nodes.begin(), nodes.end(), [&](Local n) { return !edge.has(n); });
    return {true, {{{edge.a, inside}, {edge.b, inside}}}};
  }

  // Of a strip the edges of its faces that start at both ends of `edge` and have no other faces of it beyond.
  std::optional<Straight> along_strip(const std::vector<std::size_t>& strip, const Edge& edge) const
  {
    Straight result{false, {{{edge.a, -1}, {edge.b, -1}}}};
    for (const std::size_t f : strip) {
      const auto& nodes = faces_[f].nodes;
      for (std::size_t k = 0; k < nodes.size(); ++k) {
        const Local a = nodes[k], b = nodes[(k + 1) % nodes.size()];
        if (edge.has(a) == edge.has(b) || is_wide_across(at(b) - at(a), strip)) continue;
        for (auto& [from, to] : result.lines)
          if (a == from || b == from) to = a == from ? b : a;
      }
    }
    if (result.lines[0][1] < 0 || result.lines[1][1] < 0) return std::nullopt;
    return result;
  }

  // Whether faces in a plane reach farther than the first of them across each of their edges.
  bool is_wide(const std::vector<std::size_t>& flat) const
  {
    for (const std::size_t f : flat)
      for (std::size_t k = 0; k < faces_[f].nodes.size(); ++k) {
        const auto& nodes = faces_[f].nodes;
        if (!is_wide_across(at(nodes[(k + 1) % nodes.size()]) - at(nodes[k]), flat)) return false;
      }
    return true;
  }

  bool is_wide_across(const Point& edge, const std::vector<std::size_t>& flat) const
  {
    const Point across = faces_[flat[0]].normal.cross(edge).normalized();
    const auto extent = [&](std::size_t f) {
      double least = std::numeric_limits<double>::infinity(), most = -least;
      for (const Local n : faces_[f].nodes) least = std::min(least, at(n).dot(across)), most = std::max(most, at(n).dot(across));
      return std::pair(least, most);
    };
    const auto [first, last] = extent(flat[0]);
    double least = first, most = last;
    for (const std::size_t g : flat) {
      const auto [from, to] = extent(g);
      least = std::min(least, from), most = std::max(most, to);
    }
    return most - least > two_rows * (last - first);
  }

  const Point& at(Local n) const { return all_.at(n); }

  const FaceEdges& all_;
  const std::vector<Face>& faces_;
  const std::vector<Edge>& edges_;
  const std::vector<bool>& parted_;
};

}  // namespace

std::vector<TangentEdge> find_tangent_edges(const FaceEdges& edges, const std::vector<bool>& parted)
{
  return TangentEdges(edges, parted).find();
}

}  // namespace mortise::contact
