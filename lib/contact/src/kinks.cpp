#include "kinks.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "skin.hpp"

namespace mortise::contact {

namespace {

class Kinks {
 public:
  explicit Kinks(const Side& side) : side_(side), faces_(side.faces.size())
  {
    for (std::size_t f = 0; f < faces_.size(); ++f) faces_[f] = corners_of_face(f);
    find_edges();
    // Faces behind a kink say nothing of this side of it, and make kinks of what is none: so the sharpest first.
    for (int pass = 0; pass < passes; ++pass)
      if (!part_sharpest()) break;
  }

  std::vector<FacetEdge> kinks() const
  {
    std::vector<FacetEdge> result;
    for (std::size_t e = 0; e < edges_.size(); ++e)
      if (parted_[e])
        for (const FacetEdge& edge : facet_edges(edges_[e])) result.push_back(edge);
    std::sort(result.begin(), result.end());
    return result;
  }

  std::vector<TangentEdge> tangent_edges() const
  {
    std::vector<TangentEdge> result;
    for (std::size_t e = 0; e < edges_.size(); ++e)
      if (const Local in_plane = parted_[e] ? -1 : node_of_plane(edges_[e]); in_plane >= 0)
        for (const FacetEdge& edge : facet_edges(edges_[e])) result.push_back({edge, in_plane});
    std::sort(result.begin(), result.end());
    return result;
  }

 private:
  // Slopes of two faces that differ by less than 2 degrees leave too little between the surface through them and the faces.
  static constexpr double least_turn = 0.035;
  // The part of it that the surfaces on both sides alone differ by: these are nearly plane. Coarse waves and bumps turn by as much
  // as kinks between curved parts do, but from face to face.
  static constexpr double of_a_kink = 0.85;
  // Faces reach so far from an edge, over what the one at the edge does, where there are two rows of them.
  static constexpr double two_rows = 1.5;
  // Of the angle between two faces of an arc: others differ by no more.
  static constexpr double same_turn = 0.05;
  // Of the least squares: a curvature that the nodes do not determine is 0.
  static constexpr double held = 1e-8;
  static constexpr int steps = 4;
  static constexpr std::size_t usual_round = 12;  // faces, to make room for
  static constexpr int passes = 4;
  static constexpr double equal = 1 + 1e-9;

  // An edge between two faces.
  struct Edge {
    Local a, b;
    std::array<std::size_t, 2> faces;
  };

  // What an edge looks like: its middle, half of its length, the mean normal there and the directions along it and across, from the
  // first face to the other.
  struct Place {
    Point middle, normal, along, away;
    double half;
  };

  // The surface on one side of an edge: with x along it and y > 0 away from it into that side,
  // z - bend z^2 / 2 = slope y + across y^2 / 2 + twist x y + along (x^2 - half^2) / 2.
  struct Surface {
    Point away;
    double depth = 0;    // of the face at the edge
    // The faces on this side that share nodes with the one at the edge, and hang together with it.
    std::vector<std::size_t> round;
    bool known = false;  // there are two rows of faces; else the rest is not
    double slope = 0, across = 0, twist = 0, along = 0, bend = 0;
    std::array<double, 2> next{0, 0};  // slopes of the faces of the second row and of the third, less that of the first,
    std::array<int, 2> faces{0, 0};    // and how many these are
  };

  struct Face {
    FaceGeometry geometry;
    Few<Local, 4> nodes;
    Point centre, normal;
    Few<std::pair<std::size_t, std::size_t>, 4> beside;  // a face, and the edge that leads to it
  };

  const Point& at(Local n) const { return side_.points[static_cast<std::size_t>(n)]; }

  Face corners_of_face(std::size_t f) const
  {
    Face face;
    const auto corners = static_cast<std::size_t>(mesh::corner_count(side_.faces.type[f]));
    face.geometry.type =
        corners == 2 ? mesh::CellType::line2 : corners == 3 ? mesh::CellType::tri3 : mesh::CellType::quad4;
    for (std::size_t k = 0; k < corners; ++k) {
      face.nodes.push_back(side_.faces[f][k]);
      face.geometry.nodes.push_back(at(side_.faces[f][k]));
    }
    face.centre = face.geometry.centre();
    face.normal = face.geometry.normal();
    return face;
  }

  void find_edges()
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
    parted_.assign(edges_.size(), false);
  }

  // Of the edges that seem to be kinks, those that are sharper than all others which lie between the faces that say so. Whether
  // there are more of them now.
  bool part_sharpest()
  {
    std::vector<double> turn(edges_.size());
    for (std::size_t e = 0; e < edges_.size(); ++e) turn[e] = parted_[e] ? 0 : turn_at(edges_[e]);
    std::vector<std::size_t> sharpest, crossed;
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      if (turn[e] == 0) continue;
      crossed.clear();
      turn_at(edges_[e], &crossed);
      if (std::all_of(crossed.begin(), crossed.end(), [&](std::size_t c) { return turn[c] <= equal * turn[e]; }))
        sharpest.push_back(e);
    }
    for (const std::size_t e : sharpest) parted_[e] = true;
    return !sharpest.empty();
  }

  Place place_of(const Edge& edge) const
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

  // A node beyond the edge on the side that is plane; -1: none is, or both are.
  Local node_of_plane(const Edge& edge) const
  {
    const auto [first, last] = edge.faces;
    if (coplanar(first, last)) return -1;
    const Place place = place_of(edge);
    bool back = is_plane(first, place, -place.away), forth = is_plane(last, place, place.away);
    if (!back && !forth) back = ends_arc(first, last, edge), forth = ends_arc(last, first, edge);
    if (back == forth) return -1;
    const auto& nodes = faces_[back ? first : last].nodes;
    return *std::find_if(nodes.begin(), nodes.end(), [&](Local n) { return n != edge.a && n != edge.b; });
  }

  bool coplanar(std::size_t f, std::size_t g) const { return (faces_[f].normal - faces_[g].normal).norm() < rounding; }

  // Whether a face goes on to a second row away from an edge of its own, through faces of its plane that share nodes with it, and
  // these are more than one strip: those of a cylinder between two of its straight lines are no plane.
  bool is_plane(std::size_t own, const Place& place, const Point& away) const
  {
    const auto touches = [&](const Face& face) {
      return std::any_of(face.nodes.begin(), face.nodes.end(), [&](Local n) {
        return std::find(faces_[own].nodes.begin(), faces_[own].nodes.end(), n) != faces_[own].nodes.end();
      });
    };
    std::vector<std::size_t> plane{own};
    double farthest = 0;
    for (std::size_t i = 0; i < plane.size(); ++i) {
      farthest = std::max(farthest, depth(faces_[plane[i]], place, away));
      for (const auto& [f, e] : faces_[plane[i]].beside)
        if (!parted_[e] && coplanar(own, f) && touches(faces_[f]) && std::find(plane.begin(), plane.end(), f) == plane.end())
          plane.push_back(f);
    }
    return farthest > two_rows * depth(faces_[own], place, away) && (faces_[own].nodes.size() == 2 || is_wide(plane));
  }

  // Whether a face is tangential to an arc that ends at an edge of it: three faces of a circle turn by the same angle, and the plane
  // by half of it. This tells planes of a single row. Triangles scatter too much.
  bool ends_arc(std::size_t plane, std::size_t arc, const Edge& edge) const
  {
    if (faces_[arc].nodes.size() == 3 || !goes_on_along(plane, edge)) return false;
    const auto second = next_beyond(arc, edge.a, edge.b);
    if (!second) return false;
    const Edge& between = edges_[second->second];
    const auto third = next_beyond(second->first, between.a, between.b);
    if (!third) return false;
    const double whole = angle(arc, second->first);
    return std::abs(angle(second->first, third->first) - whole) < same_turn * whole &&
           std::abs(angle(plane, arc) - whole / 2) < same_turn * whole &&
           (faces_[arc].normal - faces_[plane].normal).dot(faces_[second->first].normal - faces_[arc].normal) > 0;
  }

  double angle(std::size_t f, std::size_t g) const { return 2 * std::asin((faces_[f].normal - faces_[g].normal).norm() / 2); }

  // The face on the other side of one with two or four nodes than the edge from a to b, and the edge to it.
  std::optional<std::pair<std::size_t, std::size_t>> next_beyond(std::size_t face, Local a, Local b) const
  {
    for (const auto& [f, e] : faces_[face].beside) {
      const auto is_end = [&](Local n) { return n == edges_[e].a || n == edges_[e].b; };
      if (!parted_[e] && !is_end(a) && !is_end(b)) return std::pair(f, e);
    }
    return std::nullopt;
  }

  // Whether there is another face of its plane beside it at the same line, as a cylinder has none; in plane models always.
  bool goes_on_along(std::size_t plane, const Edge& edge) const
  {
    return edge.a == edge.b || std::any_of(faces_[plane].beside.begin(), faces_[plane].beside.end(), [&](const auto& beside) {
             const Edge& other = edges_[beside.second];
             const bool at_line = other.a == edge.a || other.a == edge.b || other.b == edge.a || other.b == edge.b;
             return at_line && !parted_[beside.second] && coplanar(plane, beside.first);
           });
  }

  // Whether faces in a plane reach farther than the first of them across each of their edges.
  bool is_wide(const std::vector<std::size_t>& plane) const
  {
    const auto extent = [&](std::size_t f, const Point& along) {
      double least = std::numeric_limits<double>::infinity(), most = -least;
      for (const Local n : faces_[f].nodes) least = std::min(least, at(n).dot(along)), most = std::max(most, at(n).dot(along));
      return std::pair(least, most);
    };
    for (const std::size_t f : plane)
      for (std::size_t k = 0; k < faces_[f].nodes.size(); ++k) {
        const auto& nodes = faces_[f].nodes;
        const Point across = faces_[plane[0]].normal.cross(at(nodes[(k + 1) % nodes.size()]) - at(nodes[k])).normalized();
        const auto [first, last] = extent(plane[0], across);
        double least = first, most = last;
        for (const std::size_t g : plane) {
          const auto [from, to] = extent(g, across);
          least = std::min(least, from), most = std::max(most, to);
        }
        if (!(most - least > two_rows * (last - first))) return false;
      }
    return true;
  }

  double depth(const Face& face, const Place& place, const Point& away) const
  {
    double result = 0;
    for (const Local n : face.nodes) result = std::max(result, (at(n) - place.middle).dot(away));
    return result;
  }

  // The angle of a kink, as a difference of slopes; 0: there is none. `crossed`: gets the edges between the faces that tell.
  double turn_at(const Edge& edge, std::vector<std::size_t>* crossed = nullptr) const
  {
    const Face &first = faces_[edge.faces[0]], &last = faces_[edge.faces[1]];
    if ((first.normal - last.normal).squaredNorm() < least_turn * least_turn) return 0;
    const Place place = place_of(edge);
    const Point& away = place.away;
    const double faces = std::abs(slope_of(last, place, away) - slope_of(first, place, away));
    Surface back = rows_beside(edge, 0, place, -away, crossed), forth = rows_beside(edge, 1, place, away, crossed);
    if (!back.known && !forth.known) return 0;
    const bool both = back.known && forth.known;
    Surface &known = back.known ? back : forth, &other = back.known ? forth : back;
    if (!both && known.faces[1] == 0) return 0;  // two rows of a curve may turn by nothing
    // Of slopes: from each face to the next one beyond. Where that is as much as between the two, as on smooth curves, no fit is needed.
    const double beside = both ? (std::abs(back.next[0]) + std::abs(forth.next[0])) / 2
                               : std::max(std::abs(known.next[0]), std::abs(known.next[1]));
    if (!(faces - beside > of_a_kink * faces)) return 0;
    // At the edge itself, and from the middle of one face to that of the other.
    fit(edge, place, known);
    double turn = 0, smooth = 0;
    if (both) {
      fit(edge, place, other);
      turn = back.slope + forth.slope;
      smooth = (std::abs(back.across) * back.depth + std::abs(forth.across) * forth.depth) / 2;
    } else {
      turn = turn_beyond(known, edge, faces_[edge.faces[back.known ? 1 : 0]], place);
      smooth = std::abs(known.across) * (known.depth + other.depth) / 2;
    }
    turn = std::abs(turn);
    return turn > least_turn && turn > of_a_kink * (turn + smooth) ? turn : 0;
  }

  // The faces on one side of an edge, and how much they turn from row to row.
  Surface rows_beside(const Edge& edge, int which, const Place& place, const Point& away, std::vector<std::size_t>* crossed) const
  {
    const std::size_t own = edge.faces[static_cast<std::size_t>(which)];
    Surface result;
    result.away = away;
    result.depth = depth(faces_[own], place, away);
    auto& round = result.round;
    round.reserve(usual_round);
    round.push_back(own);
    double farthest = 0;
    for (std::size_t i = 0; i < round.size(); ++i) {
      const Face& face = faces_[round[i]];
      farthest = std::max(farthest, depth(face, place, away));
      for (const auto& [f, e] : face.beside) {
        const Face& next = faces_[f];
        const auto touches = [&](Local n) {
          return std::find(faces_[own].nodes.begin(), faces_[own].nodes.end(), n) != faces_[own].nodes.end();
        };
        if (parted_[e] || (next.centre - place.middle).dot(away) <= 0) continue;
        if (std::none_of(next.nodes.begin(), next.nodes.end(), touches)) continue;
        if (crossed) crossed->push_back(e);
        if (std::find(round.begin(), round.end(), f) == round.end()) round.push_back(f);
      }
    }
    result.known = farthest > two_rows * result.depth;
    if (!result.known) return result;
    const double slope = slope_of(faces_[own], place, away);
    const auto note = [&](std::size_t row, const Face& face) {
      result.next[row] += slope_of(face, place, away) - slope;
      ++result.faces[row];
    };
    for (const std::size_t f : round) {
      const Face& face = faces_[f];
      const auto has = [&](Local n) { return std::find(face.nodes.begin(), face.nodes.end(), n) != face.nodes.end(); };
      if (has(edge.a) || has(edge.b)) continue;
      note(0, face);
      for (const auto& [g, e] : face.beside)
        if (!parted_[e] && std::find(round.begin(), round.end(), g) == round.end() &&
            (faces_[g].centre - face.centre).dot(away) > std::abs((faces_[g].centre - face.centre).dot(place.along)))
          note(1, faces_[g]);
    }
    for (const std::size_t row : {0U, 1U}) result.next[row] /= std::max(result.faces[row], 1);
    return result;
  }

  static double slope_of(const Face& face, const Place& place, const Point& away)
  {
    return -face.normal.dot(away) / face.normal.dot(place.normal);
  }

  // With the larger curvature for the bend, in the least squares of both sides over the squared distance: exact on spheres and
  // cylinders.
  void fit(const Edge& edge, const Place& place, Surface& surface) const
  {
    std::vector<Local> nodes;
    for (const std::size_t f : surface.round)
      for (const Local n : faces_[f].nodes)
        if (n != edge.a && n != edge.b && std::find(nodes.begin(), nodes.end(), n) == nodes.end()) nodes.push_back(n);
    const double unit = surface.depth, half = place.half / unit;
    Eigen::Vector4d found = Eigen::Vector4d::Zero();
    double bend = 0;
    for (int step = 0; step < steps; ++step) {
      bend = std::abs(found[1]) > std::abs(found[3]) ? found[1] : found[3];
      Eigen::Matrix4d matrix = Eigen::Vector4d(0, held, held, held).asDiagonal();
      Eigen::Vector4d right = Eigen::Vector4d::Zero();
      for (const Local n : nodes) {
        const Point d = (at(n) - place.middle) / unit;
        const double x = d.dot(place.along), y = d.dot(surface.away), z = d.dot(place.normal), weight = 1 / d.squaredNorm();
        const Eigen::Vector4d row = weight * Eigen::Vector4d(y, y * y / 2, x * y, (x * x - half * half) / 2);
        matrix += row * row.transpose();
        right += weight * (z - bend * z * z / 2) * row;
      }
      found = matrix.ldlt().solve(right);
    }
    surface.slope = found[0];
    surface.across = found[1] / unit, surface.twist = found[2] / unit, surface.along = found[3] / unit;
    surface.bend = bend / unit;
  }

  // How much steeper than the surface of the other side, continued, the nodes of a face lie.
  double turn_beyond(const Surface& known, const Edge& edge, const Face& face, const Place& place) const
  {
    double sum = 0;
    int count = 0;
    for (const Local n : face.nodes) {
      if (n == edge.a || n == edge.b) continue;
      const Point d = at(n) - place.middle;
      const double x = d.dot(place.along), y = d.dot(known.away), z = d.dot(place.normal);
      const double continued = known.slope * y + known.across * y * y / 2 + known.twist * x * y +
                               known.along * (x * x - place.half * place.half) / 2;
      sum += (z - known.bend * z * z / 2 - continued) / -y;
      ++count;
    }
    return sum / count;
  }

  // A node in the middle of an edge of a face of second order cuts it in two.
  Few<FacetEdge, 2> facet_edges(const Edge& edge) const
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

  const Side& side_;
  std::vector<Face> faces_;
  std::vector<Edge> edges_;
  std::vector<bool> parted_;  // of each edge: a kink that was found before
};

}  // namespace

void find_kinks(Side& side)
{
  const Kinks kinks(side);
  side.kinks = kinks.kinks();
  side.tangent_edges = kinks.tangent_edges();
}

}  // namespace mortise::contact
