#include "surface/kinks.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/dense.hpp"
#include "surface/common_kinks.hpp"
#include "surface/curved_borders.hpp"
#include "surface/face_edges.hpp"
#include "surface/tangent_edges.hpp"

namespace mortise::contact {

namespace {

class Kinks {
 public:
  explicit Kinks(const FaceEdges& all)
      : all_(all),
        faces_(all.faces()),
        edges_(all.edges()),
        parted_(edges_.size(), false),
        likely_(likely_kinks(all)),
        parted_or_likely_(likely_)
  {
    // Faces behind a kink say nothing of this side of it, and make kinks of what is none: so the sharpest first.
    for (int pass = 0; pass < passes; ++pass)
      if (!part_sharpest()) break;
  }

  // Of each edge.
  const std::vector<bool>& parted() const { return parted_; }
  void part(std::size_t edge) { parted_[edge] = true; }

  // Edges at which the side turns.
  std::vector<TurnedEdge> turned() const
  {
    std::vector<TurnedEdge> result;
    for (const Edge& edge : edges_)
      if (const auto found = turned(edge)) result.push_back(*found);
    return result;
  }

  // Whether an edge that lies upon one of the other side, as others do that are `shared`, seems to be a kink: corners turn by
  // more than they do to the next rows, up to shared edges. Where these cut a row off on both sides of the contact, as in meshes
  // that match, it may be none: `maybe`.
  enum class StandsOut { no, maybe, yes };
  // Notes the faces beside the edge, too.
  StandsOut stands_out(TurnedEdge& turned, const std::vector<bool>& shared) const
  {
    constexpr double over_next = 2.1, maybe_over_next = 1.5;  // on waves of faces of one size: up to 2
    const Edge& edge = edges_[turned.edge];
    const Frame frame = all_.frame_of(edge);
    bool known = false, cut = false;
    double next = 0;
    for (const std::size_t which : {0U, 1U}) {
      const Point away = which == 0 ? Point(-frame.away) : frame.away;
      const Surface side = rows_beside(edge, static_cast<int>(which), frame, away, shared, nullptr);
      const bool any = side.faces[0] > 0;
      known = known || any;
      cut = cut || (!any && side.cut);
      if (any) next = std::max(next, side.faces[1] > 0 ? side.most_next() : std::abs(side.next[0]));
      turned.wings[which] = wing(edge, which, frame, side);
    }
    if (parted_[turned.edge]) return StandsOut::yes;
    if (known ? std::abs(turned.turn) <= maybe_over_next * next : !cut) return StandsOut::no;
    return cut || std::abs(turned.turn) <= over_next * next ? StandsOut::maybe : StandsOut::yes;
  }

 private:
  using Edge = FaceEdges::Edge;
  using Face = FaceEdges::Face;
  using Frame = FaceEdges::Frame;

  // The part of it that the surfaces on both sides alone differ by: these are nearly plane. Coarse waves and bumps turn by as
  // much as kinks between curved parts do, but from face to face.
  static constexpr double of_a_kink = 0.85;
  // It is less where corners turn by so many times what they do from row to row on both sides: on a smooth wave by no more than
  // two times.
  static constexpr double of_a_peak = 0.6, over_rows = 2.5;
  // The part of it that curved faces have to turn by themselves: coarse faces of second order know more of waves than their
  // corners.
  static constexpr double of_curved = 0.5;
  // Faces reach so far from an edge, over what the one at the edge does, where there are two rows of them.
  static constexpr double two_rows = 1.5, any_row = 1.01;
  // Of the least squares: a curvature that the nodes do not determine is 0.
  static constexpr double held = 1e-8;
  static constexpr int steps = 4;
  static constexpr std::size_t usual_round = 12;  // faces, to make room for
  static constexpr int passes = 4;
  static constexpr double equal = 1 + 1e-9;

  // The surface on one side of an edge: with x along it and y > 0 away from it into that side,
  // z - bend z^2 / 2 = slope y + across y^2 / 2 + twist x y + along (x^2 - half^2) / 2.
  struct Surface {
    Point away;
    double depth = 0;  // of the face at the edge
    // The faces on this side that share nodes with the one at the edge, and hang together with it.
    std::vector<std::size_t> round;
    bool known = false;  // there are two rows of faces; else the rest is not,
    bool cut = false;    // and that may be for edges at which rows end
    double slope = 0, across = 0, twist = 0, along = 0, bend = 0;
    std::array<double, 2> next{0, 0};  // slopes of the faces of the second row and of the third, less that of the first,
    std::array<int, 2> faces{0, 0};    // and how many these are

    double most_next() const { return std::max(std::abs(next[0]), std::abs(next[1] - next[0])); }
  };

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
    for (const std::size_t e : sharpest) parted_[e] = parted_or_likely_[e] = true;
    return !sharpest.empty();
  }

  TurnedEdge::Wing wing(const Edge& edge, std::size_t which, const Frame& frame, const Surface& side) const
  {
    const Face& face = faces_[edge.faces[which]];
    Point sum = Point::Zero();
    int count = 0;
    for (const Local n : face.nodes)
      if (!edge.has(n)) sum += all_.at(n), ++count;
    return {side.away, sum / count, side.depth, FaceEdges::slope(face, frame, side.away), side.faces[0] > 0 ? side.next[0] : 0};
  }

  std::optional<TurnedEdge> turned(const Edge& edge) const
  {
    const Face &first = faces_[edge.faces[0]], &last = faces_[edge.faces[1]];
    if ((first.normal - last.normal).squaredNorm() < least_kink * least_kink) return std::nullopt;
    const Frame frame = all_.frame_of(edge);
    const double turn = FaceEdges::slope(last, frame, frame.away) - FaceEdges::slope(first, frame, frame.away);
    if (const auto& curved = curved_of(edge); curved && *curved / turn < of_curved) return std::nullopt;
    const double depth = std::min(all_.depth(edge.faces[0], frame, -frame.away), all_.depth(edge.faces[1], frame, frame.away));
    return TurnedEdge{index_of(edge), frame.middle, frame.along, frame.normal, frame.half, depth, turn};
  }

  // The angle of a kink, as a difference of slopes; 0: there is none. `crossed`: gets the edges between the faces that tell.
  double turn_at(const Edge& edge, std::vector<std::size_t>* crossed = nullptr) const
  {
    const Face &first = faces_[edge.faces[0]], &last = faces_[edge.faces[1]];
    if ((first.normal - last.normal).squaredNorm() < least_kink * least_kink) return 0;
    const Frame frame = all_.frame_of(edge);
    const Point& away = frame.away;
    const double corners = FaceEdges::slope(last, frame, away) - FaceEdges::slope(first, frame, away), faces = std::abs(corners);
    if (const double turn = turn_of_curved_alone(edge, frame, corners); turn > 0) return turn;
    Surface back = rows_beside(edge, 0, frame, -away, parted_, crossed),
            forth = rows_beside(edge, 1, frame, away, parted_, crossed);
    if (!back.known && !forth.known) return 0;
    const bool both = back.known && forth.known;
    Surface &known = back.known ? back : forth, &other = back.known ? forth : back;
    if (!both && known.faces[1] == 0) return 0;  // two rows of a curve may turn by nothing
    // Of slopes: from each face to the next one beyond. Where that is as much as between the two, as on smooth curves, no fit is
    // needed.
    const double beside = both ? (std::abs(back.next[0]) + std::abs(forth.next[0])) / 2
                               : std::max(std::abs(known.next[0]), std::abs(known.next[1]));
    const bool peak =
        both && back.faces[1] > 0 && forth.faces[1] > 0 && faces > over_rows * std::max(back.most_next(), forth.most_next());
    if (!peak && !(faces - beside > of_a_kink * faces)) return 0;
    // At the edge itself, and from the middle of one face to that of the other.
    fit(edge, frame, known);
    double turn = 0, smooth = 0;
    if (both) {
      fit(edge, frame, other);
      turn = back.slope + forth.slope;
      smooth = (std::abs(back.across) * back.depth + std::abs(forth.across) * forth.depth) / 2;
    } else {
      turn = turn_beyond(known, edge, faces_[edge.faces[back.known ? 1 : 0]], frame);
      smooth = std::abs(known.across) * (known.depth + other.depth) / 2;
    }
    if (const auto curved = curved_of(edge); curved && *curved / turn < of_curved) return 0;
    turn = std::abs(turn);
    return turn > least_kink && turn > (peak ? of_a_peak : of_a_kink) * (turn + smooth) ? turn : 0;
  }

  std::size_t index_of(const Edge& edge) const { return static_cast<std::size_t>(&edge - edges_.data()); }
  const std::optional<double>& curved_of(const Edge& edge) const { return all_.turn_of_curved(index_of(edge)); }

  // Edges at which curved faces turn by much of what their corners do: each of two beside a strip one face wide hides the other.
  static std::vector<bool> likely_kinks(const FaceEdges& all)
  {
    std::vector<bool> result(all.edges().size());
    for (std::size_t e = 0; e < result.size(); ++e) {
      const auto& [first, last] = all.edges()[e].faces;
      const double corners = (all.faces()[first].normal - all.faces()[last].normal).norm();
      const double turn = std::abs(all.turn_of_curved(e).value_or(0));
      result[e] = turn > least_kink && turn > of_curved * corners;
    }
    return result;
  }

  // The angle of a kink between curved faces that need no others to tell; 0: there is none, or others have to.
  double turn_of_curved_alone(const Edge& edge, const Frame& frame, double corners) const
  {
    const auto& own = curved_of(edge);
    if (!own) return 0;
    const auto is_kink_among = [&](const std::vector<bool>& parted) {
      const auto around = [&](std::size_t side) { return all_.around(edge.faces[side], edge.a, edge.b, frame, parted); };
      return is_kink_of_curved(*own, corners, around(0), around(1));
    };
    if (is_kink_among(parted_)) return std::abs(*own);
    if (!likely_[index_of(edge)]) return 0;
    return is_kink_among(parted_or_likely_) ? std::abs(*own) : 0;
  }

  // The faces on one side of an edge, up to others that are `ends`, and how much they turn from row to row.
  Surface rows_beside(const Edge& edge, int which, const Frame& frame, const Point& away, const std::vector<bool>& ends,
                      std::vector<std::size_t>* crossed) const
  {
    const std::size_t own = edge.faces[static_cast<std::size_t>(which)];
    Surface result;
    result.away = away;
    result.depth = all_.depth(own, frame, away);
    auto& round = result.round;
    round.reserve(usual_round);
    round.push_back(own);
    double farthest = 0;
    for (std::size_t i = 0; i < round.size(); ++i) {
      const Face& face = faces_[round[i]];
      farthest = std::max(farthest, all_.depth(round[i], frame, away));
      for (const auto& [f, e] : face.beside) {
        const Face& next = faces_[f];
        const auto touches = [&](Local n) {
          return std::find(faces_[own].nodes.begin(), faces_[own].nodes.end(), n) != faces_[own].nodes.end();
        };
        if ((next.centre - frame.middle).dot(away) <= 0) continue;
        result.cut = result.cut || ends[e];
        if (ends[e]) continue;
        if (std::none_of(next.nodes.begin(), next.nodes.end(), touches)) continue;
        if (crossed) crossed->push_back(e);
        if (std::find(round.begin(), round.end(), f) == round.end()) round.push_back(f);
      }
    }
    result.known = farthest > two_rows * result.depth;
    if (farthest <= any_row * result.depth) return result;
    const double slope = FaceEdges::slope(faces_[own], frame, away);
    const auto note = [&](std::size_t row, const Face& face) {
      result.next[row] += FaceEdges::slope(face, frame, away) - slope;
      ++result.faces[row];
    };
    for (const std::size_t f : round) {
      const Face& face = faces_[f];
      const auto has = [&](Local n) { return std::find(face.nodes.begin(), face.nodes.end(), n) != face.nodes.end(); };
      if (has(edge.a) || has(edge.b)) continue;
      note(0, face);
      for (const auto& [g, e] : face.beside)
        if (!ends[e] && std::find(round.begin(), round.end(), g) == round.end() &&
            (faces_[g].centre - face.centre).dot(away) > std::abs((faces_[g].centre - face.centre).dot(frame.along)))
          note(1, faces_[g]);
    }
    for (const std::size_t row : {0U, 1U}) result.next[row] /= std::max(result.faces[row], 1);
    return result;
  }

  // With the larger curvature for the bend, in the least squares of both sides over the squared distance: exact on spheres and
  // cylinders.
  void fit(const Edge& edge, const Frame& frame, Surface& surface) const
  {
    std::vector<Local> nodes;
    for (const std::size_t f : surface.round)
      for (const Local n : faces_[f].nodes)
        if (n != edge.a && n != edge.b && std::find(nodes.begin(), nodes.end(), n) == nodes.end()) nodes.push_back(n);
    const double unit = surface.depth, half = frame.half / unit;
    Eigen::Vector4d found = Eigen::Vector4d::Zero();
    double bend = 0;
    for (int step = 0; step < steps; ++step) {
      bend = std::abs(found[1]) > std::abs(found[3]) ? found[1] : found[3];
      Eigen::Matrix4d matrix = Eigen::Vector4d(0, held, held, held).asDiagonal();
      Eigen::Vector4d right = Eigen::Vector4d::Zero();
      for (const Local n : nodes) {
        const Point d = (all_.at(n) - frame.middle) / unit;
        const double x = d.dot(frame.along), y = d.dot(surface.away), z = d.dot(frame.normal), weight = 1 / d.squaredNorm();
        const Eigen::Vector4d row = weight * Eigen::Vector4d(y, y * y / 2, x * y, (x * x - half * half) / 2);
        matrix += row * row.transpose();
        right += weight * (z - bend * z * z / 2) * row;
      }
      found = dense::solve_symmetric(matrix, right);
    }
    surface.slope = found[0];
    surface.across = found[1] / unit, surface.twist = found[2] / unit, surface.along = found[3] / unit;
    surface.bend = bend / unit;
  }

  // How much steeper than the surface of the other side, continued, the nodes of a face lie.
  double turn_beyond(const Surface& known, const Edge& edge, const Face& face, const Frame& frame) const
  {
    double sum = 0;
    int count = 0;
    for (const Local n : face.nodes) {
      if (n == edge.a || n == edge.b) continue;
      const Point d = all_.at(n) - frame.middle;
      const double x = d.dot(frame.along), y = d.dot(known.away), z = d.dot(frame.normal);
      const double continued =
          known.slope * y + known.across * y * y / 2 + known.twist * x * y + known.along * (x * x - frame.half * frame.half) / 2;
      sum += (z - known.bend * z * z / 2 - continued) / -y;
      ++count;
    }
    return sum / count;
  }

  const FaceEdges& all_;
  const std::vector<Face>& faces_;
  const std::vector<Edge>& edges_;
  std::vector<bool> parted_;        // of each edge: a kink that was found before
  const std::vector<bool> likely_;  // of each edge
  std::vector<bool> parted_or_likely_;
};

}  // namespace

namespace {

void set_kinks(Side& side, const FaceEdges& edges, const Kinks& kinks)
{
  side.kinks.clear();
  for (std::size_t e = 0; e < edges.edges().size(); ++e)
    if (kinks.parted()[e])
      for (const FacetEdge& edge : edges.facet_edges(edges.edges()[e])) side.kinks.push_back(edge);
  std::sort(side.kinks.begin(), side.kinks.end());
  side.tangent_edges = find_tangent_edges(edges, kinks.parted());
}

// A side of a contact whose kinks the other one knows as well.
class SharedKinks {
 public:
  explicit SharedKinks(Side& side) : side_(side), edges_(side), kinks_(edges_), turned_(kinks_.turned()) {}

  // In this order, each of both sides before the next.
  void note_shared(const SharedKinks& other)
  {
    shared_.assign(edges_.edges().size(), false);
    for (const std::size_t i : lie_upon_others(turned_, other.turned_)) shared_[turned_[i].edge] = true;
  }
  void find_what_stands_out()
  {
    for (auto& edge : turned_) {
      const auto stands_out = shared_[edge.edge] ? kinks_.stands_out(edge, shared_) : Kinks::StandsOut::no;
      if (stands_out != Kinks::StandsOut::no) maybe_.push_back(edge);
      if (stands_out == Kinks::StandsOut::yes) surely_.push_back(edge);
    }
  }
  void set_kinks_in_common(const SharedKinks& other)
  {
    for (const std::size_t i : share_kinks(maybe_, other.surely_)) kinks_.part(maybe_[i].edge);
    for (const std::size_t i : share_kinks(surely_, other.maybe_)) kinks_.part(surely_[i].edge);
    set_kinks(side_, edges_, kinks_);
  }

 private:
  Side& side_;
  const FaceEdges edges_;
  Kinks kinks_;
  std::vector<TurnedEdge> turned_, maybe_, surely_;  // the last two: kinks, as far as this side tells
  std::vector<bool> shared_;
};

}  // namespace

void find_kinks(Side& side)
{
  const FaceEdges edges(side);
  set_kinks(side, edges, Kinks(edges));
}

void find_kinks(Side& secondary, Side& primary)
{
  SharedKinks here(secondary), there(primary);
  here.note_shared(there);
  there.note_shared(here);
  here.find_what_stands_out();
  there.find_what_stands_out();
  here.set_kinks_in_common(there);
  there.set_kinks_in_common(here);
}

}  // namespace mortise::contact
