#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>

#include "base/error.hpp"
#include "by_node.hpp"
#include "contact/cyclic.hpp"
#include "contact/mortar.hpp"
#include "cut_faces.hpp"
#include "discretization.hpp"
#include "face_integrals.hpp"
#include "moments.hpp"
#include "nearest_points.hpp"
#include "one_part.hpp"
#include "one_surface.hpp"
#include "opposite.hpp"
#include "rows.hpp"
#include "sector_cuts.hpp"
#include "share.hpp"
#include "supported_nodes.hpp"

namespace mortise::contact {

namespace {

// A surface node covered by less than this part of its surroundings gets no multiplier.
constexpr double least_cover = 0.01;
// Less than this part of a facet is covered by chance.
constexpr double least_piece = 0.01;

Tree tree_of_facets(const Side& side)
{
  std::vector<Box> boxes(side.facets.size());
  for (std::size_t f = 0; f < boxes.size(); ++f)
    for (const Local n : side.facets[f]) boxes[f].extend(side.points[static_cast<std::size_t>(n)]);
  return Tree(std::move(boxes));
}

// Of the distance that the search goes, and of a place's distance from the origin.
constexpr double rounding_of_gap = 1e-12, rounding_of_coordinates = 1e-15;

// A node that has rows of a contact that is not bonded.
struct PressedNode {
  Global node;
};

// One contact on its way from faces to rows: those of the nodes that are this rank's.
class Builder {
 public:
  // `pressed_nodes`: nodes of share.secondary that have rows of contacts that are not bonded.
  Builder(const Options& options, const Share& share, double reach, int index, const SupportDirectory& supports,
          const std::vector<PressedNode>& pressed_nodes, const CurvedFaces& curved, fem::Kinematics kinematics,
          const Communicator& comm)
      : options_(options),
        index_(index),
        reach_(reach),
        dimension_(fem::dimension(kinematics)),
        axisymmetric_(kinematics == fem::Kinematics::axisymmetric),
        share_(share),
        secondary_(share.secondary),
        primary_(share.primary),
        pressed_nodes_(pressed_nodes),
        nodes_(find_surface_nodes(secondary_)),
        primary_nodes_(find_surface_nodes(primary_)),
        faces_(secondary_, nodes_, share.own),
        tree_(tree_of_facets(primary_)),
        rays_(secondary_, nodes_, primary_, primary_nodes_, tree_, options.obstacle, reach),
        mesh_gaps_(options.law != Law::bonded && !options.clearance),
        nearest_(mesh_gaps_ ? nearest_points(secondary_, nodes_, faces_.round(), rays_) : std::vector<NearestPoint>()),
        discretization_(
            make_discretization(options.discretization, {secondary_, nodes_, primary_, primary_nodes_, tree_, faces_, rays_,
                                                         options.obstacle.has_value(), reach, mesh_gaps_, nearest_})),
        one_surface_(asks_geometry(options) ? OneSurface(secondary_, nodes_, primary_, curved, rotation_of(options), comm)
                                            : OneSurface()),
        supports_(supports, secondary_.node_id, comm),
        primary_supports_(supports, primary_.node_id, comm),
        writer_(secondary_, primary_, supports_, primary_supports_, dimension_, rotation_of(options))
  {
  }

  // Of this rank's surface nodes.
  double covered_area() const { return covered_area_; }

  // How far supports alone push the two sides into each other.
  double crossing() const { return crossing_; }
  // How far supports alone move the two sides of a bond apart.
  double tear() const { return tear_; }

  // Of this rank's points; `touching`: see InitialGap.
  const InitialGap& initial_gap() const { return initial_gap_; }
  void set_touching(double touching) { initial_gap_.touching = touching; }

  // How far the two sides are apart, at this rank's surface nodes that carry a multiplier.
  double widest_gap() const
  {
    double widest = 0;
    for (std::size_t p = 0; p < nodes_.all.size(); ++p)
      if (const double gap = own(p) && kept_[p] ? std::abs(rays_.gap(p, nodes_.all[p].normal)) : 0; std::isfinite(gap))
        widest = std::max(widest, gap);
    return widest;
  }

  void add_rows(constraint::Contacts& contacts)
  {
    for (const std::size_t f : faces_.round()) discretization_->add_face(f);
    choose_contact_nodes();
    discretization_->make_functions(kept_);
    faces_.sort_by_nodes();
    for (std::size_t p = 0; p < nodes_.all.size(); ++p)
      if (own(p) && kept_[p]) add_surface_node(p, contacts);
  }

 private:
  bool own(std::size_t surface_node) const { return share_.own[static_cast<std::size_t>(nodes_.all[surface_node].node)] != 0; }
  bool at_nearest_place(std::size_t p) const { return !nearest_.empty() && nearest_[p].found; }
  bool moved(std::size_t p) const { return !nearest_.empty() && nearest_[p].moved(); }
  bool bonded() const { return options_.law == Law::bonded; }

  // Which surface nodes carry a multiplier: covered enough, and not left out of a bond.
  void choose_contact_nodes()
  {
    const auto count = nodes_.all.size();
    std::vector<double> covered(count, 0.0), whole(count, 0.0);
    for (const std::size_t f : faces_.round())  // in the order of the faces, whatever the ranks
      for (const std::size_t i : faces_.pieces(f)) {
        const auto piece = faces_.piece(i);
        for (Eigen::Index k = 0; k < piece.covered.size(); ++k) {
          covered[faces_.place_of(f, piece, k)] += piece.covered[k];
          whole[faces_.place_of(f, piece, k)] += piece.whole[k];
        }
      }
    for (std::size_t p = 0; p < count; ++p)
      if (own(p)) covered_area_ += covered[p];
    directions_.reserve(count);
    for (const auto& surface_node : nodes_.all) {
      const Global node = secondary_.node_id[static_cast<std::size_t>(surface_node.node)];
      const std::array<bool, 3> prescribed{supports_.find(node, 0) != nullptr, supports_.find(node, 1) != nullptr,
                                           supports_.find(node, 2) != nullptr};
      directions_.push_back(directions(surface_node.normal, prescribed, supports_.skew_supports(node), dimension_));
    }
    // Where a bonded seam ends at a contact, both sides of the seam have rows of that contact, each of which says what the other
    // and the seam say: pressures that nothing shares out. As the mortar method does where multipliers meet, the seam has none
    // there.
    std::vector<char> crossing(count, 0);
    for (std::size_t p = 0; p < count && discretization_->seams_end_at_contacts(); ++p)
      crossing[p] = std::binary_search(pressed_nodes_.begin(), pressed_nodes_.end(),
                                       PressedNode{secondary_.node_id[static_cast<std::size_t>(nodes_.all[p].node)]},
                                       [](const PressedNode& a, const PressedNode& b) { return a.node < b.node; });
    // Where supports hold a tangent at all nodes of a face, see tangents().
    held_through_.assign(count, 0);
    for (const std::size_t f : faces_.round()) {
      const auto surface_nodes = faces_.surface_nodes_of(f);
      if (std::all_of(surface_nodes.begin(), surface_nodes.end(), [&](Local p) {
            return directions_[static_cast<std::size_t>(p)].tangents.size() + 1 < static_cast<std::size_t>(dimension_);
          }))
        for (const Local p : surface_nodes) held_through_[static_cast<std::size_t>(p)] = 1;
    }
    const auto left_out = [&](std::size_t p) { return !directions_[p].free_normal || crossing[p]; };
    // Surface nodes prescribed along their normal keep their rows in a contact: the primary side alone feels them (add_point()
    // drops them if it does not, as an obstacle). If their neighbours took over their share, these would see what moves along a
    // curved surface there as an overlap. In a bond they would hold the primary side to the mean of what it meets, and leave
    // their share to the others of the face, as those at a seam's end do; where a face has no others, as on a surface that a
    // support moves as a whole, they stay.
    stranded_.assign(count, 0);
    for (const std::size_t f : faces_.round()) {
      const auto surface_nodes = faces_.surface_nodes_of(f);
      if (std::all_of(surface_nodes.begin(), surface_nodes.end(), [&](Local p) { return left_out(static_cast<std::size_t>(p)); }))
        for (const Local p : surface_nodes) stranded_[static_cast<std::size_t>(p)] = 1;
    }
    cover_.assign(count, 0);
    kept_.assign(count, 0);
    freed_.assign(count, 0);
    for (std::size_t p = 0; p < count; ++p) {
      freed_[p] = (stranded_[p] || !bonded()) && !directions_[p].free_normal;
      if (freed_[p])
        directions_[p] = directions(nodes_.all[p].normal, {false, false, false}, {}, dimension_);  // moves() picks the tangents
      cover_[p] = whole[p] > 0 ? std::min(covered[p] / whole[p], 1.0) : 0.0;
      kept_[p] = (!left_out(p) || stranded_[p] || freed_[p]) && cover_[p] > least_cover;
    }
    keep_small_pieces([&](std::size_t p) { return !left_out(p) || stranded_[p] || freed_[p]; });
    if (bonded() && !options_.preload)
      for (std::size_t p = 0; p < count; ++p)
        if (own(p) && !kept_[p] && cover_[p] > least_cover) note_held_tear(p);
  }

  // Where functions with half of a piece's cover would be dropped, as opposite a foot smaller than the faces it stands on, they
  // stay: so does the border of the contact.
  template <class Allowed>
  void keep_small_pieces(const Allowed& allowed)
  {
    std::vector<std::size_t> more;
    for (const std::size_t f : faces_.round())
      for (const std::size_t i : faces_.pieces(f)) {
        const auto piece = faces_.piece(i);
        if (piece.point_facet.empty()) continue;
        const double facets = piece.facet < 0 ? static_cast<double>(secondary_.facets_of(f)) : 1;
        if (piece.covered.sum() < least_piece / facets * piece.whole.sum()) continue;
        double kept = 0;  // of the cover
        for (Eigen::Index k = 0; k < piece.covered.size(); ++k)
          if (kept_[faces_.place_of(f, piece, k)]) kept += piece.covered[k];
        if (kept > 0.5 * piece.covered.sum()) continue;
        for (Eigen::Index k = 0; k < piece.covered.size(); ++k)
          if (const auto p = faces_.place_of(f, piece, k); allowed(p) && piece.covered[k] > 0) more.push_back(p);
      }
    for (const std::size_t p : more) kept_[p] = 1;
  }

  // One term a node, summed in the order of the faces.
  void merge_terms()
  {
    std::stable_sort(terms_.begin(), terms_.end(), [](const Term& a, const Term& b) {
      return std::tie(a.on_primary, a.node) < std::tie(b.on_primary, b.node);
    });
    std::size_t end = 0;
    for (const auto& term : terms_) {
      if (end > 0 && terms_[end - 1].on_primary == term.on_primary && terms_[end - 1].node == term.node)
        terms_[end - 1].value += term.value;
      else
        terms_[end++] = term;
    }
    terms_.resize(end);
  }

  void add_surface_node(std::size_t p, constraint::Contacts& contacts)
  {
    terms_.clear();
    double d = 0, rise = 0;
    for (const auto& function : faces_.at(p)) {
      d += faces_.piece(function.piece).covered[function.k];
      rise += discretization_->rise(function);
      discretization_->add_terms(function, terms_);
    }
    if (!(d > 0)) return;
    merge_terms();
    if (at_nearest_place(p) && !options_.obstacle) take_one_part(p);
    add_point(p, d, rise, contacts);
  }

  // What is nearest there may be one of several bodies that the functions see.
  void take_one_part(std::size_t p)
  {
    const auto [at, normal] = point_of(p);
    const auto met = rays_.met_from(p, at, normal);
    if (!std::isfinite(met.gap)) return;
    if (!one_part_) one_part_.emplace(primary_);
    one_part_->take(met, terms_);
  }

  // A surface node where supports prescribe both sides. At the border of a side they may move it along a curved surface, which
  // normals of the meshes see as a little of a crossing, and what overlaps in the mesh has its own warning.
  void note_crossing(std::size_t p, double d, const Point& normal, double gap)
  {
    constexpr double along = 0.1;  // of the motion: that of what slides along a coarse mesh
    const double into = writer_.prescribed_part(terms_, d, normal);
    if (stranded_[p]) {
      crossing_ = std::max(crossing_, into - gap);
      return;
    }
    double square = into * into;
    for (const auto& tangent : directions_[p].tangents) square += std::pow(writer_.prescribed_part(terms_, d, tangent), 2);
    if (into > along * std::sqrt(square)) crossing_ = std::max(crossing_, into - std::max(gap, 0.0));
  }

  // A place of a bond along directions in which supports prescribe both sides.
  void note_tear(double d, const Point& normal)
  {
    const auto note = [&](const Point& direction) {
      if (!writer_.moves(terms_, d, direction)) tear_ = std::max(tear_, std::abs(writer_.prescribed_part(terms_, d, direction)));
    };
    note(normal);
    for (const auto& tangent : directions(normal, {false, false, false}, {}, dimension_).tangents) note(tangent);
  }

  // A place of a bond that has no multiplier since supports hold it: all that they say there of both sides, if they hold these
  // along a direction. What they say of normals of meshes may differ a little.
  void note_held_tear(std::size_t p)
  {
    constexpr double of_normals = 1e-3;
    const Opposite& opposite = rays_.meet(p);
    if (options_.obstacle || !std::isfinite(opposite.gap)) return;
    const auto nodes = primary_.faces[face_of(opposite.facet)];
    const FaceShape shape = primary_.shape_in_face(opposite.facet, opposite.hit.shape, opposite.hit.frame, Plane::Zero());
    std::vector<Term> terms{{nodes_.all[p].node, false, 1}};
    for (std::size_t j = 0; j < nodes.size(); ++j)
      if (const double part = shape[static_cast<Eigen::Index>(j)]; std::abs(part) > 1e-9)
        terms.push_back({nodes[j], true, -part});
    const Point& normal = nodes_.all[p].normal;
    const auto note = [&](const Point& direction) {
      if (writer_.moves(terms, 1, direction)) return;
      const double own = writer_.prescribed_part(std::span(terms).first(1), 1, direction),
                   other = writer_.prescribed_part(std::span(terms).subspan(1), 1, direction);
      if (std::abs(own + other) > of_normals * std::max(std::abs(own), std::abs(other)))
        tear_ = std::max(tear_, std::abs(own + other));
    };
    note(normal);
    for (const auto& tangent : directions(normal, {false, false, false}, {}, dimension_).tangents) note(tangent);
  }

  // The point of a surface node's multiplier and the secondary side's normal there: at the node, unless it was moved to where the
  // other side comes nearest, or into what is covered.
  std::pair<Point, Point> point_of(std::size_t p)
  {
    const SurfaceNode& surface_node = nodes_.all[p];
    const Point& node = secondary_.points[static_cast<std::size_t>(surface_node.node)];
    if (const auto place = nearest_place(p)) return point_at(*place);
    Point shift = Point::Zero(), tilt = Point::Zero();
    double d = 0;
    for (const auto& [face, i, k] : faces_.at(p)) {
      const auto piece = faces_.piece(i);
      d += piece.covered[k];
      if (piece.point_facet.empty() || piece.covered[k] == 0) continue;
      const auto facet = static_cast<std::size_t>(piece.point_facet[static_cast<std::size_t>(k)]);
      for (std::size_t c = 0; c < secondary_.facets[facet].size(); ++c) {
        const double part = piece.covered[k] * piece.points(k, static_cast<Eigen::Index>(c));
        shift += part * (secondary_.points[static_cast<std::size_t>(secondary_.facets[facet][c])] - node);
        tilt += part * (nodes_.normal(secondary_, facet, c) - surface_node.normal);
      }
    }
    return {node + shift / d, (surface_node.normal + tilt / d).normalized()};
  }

  std::pair<Point, Point> point_at(const Rays::FacetPoint& place) const
  {
    const auto corners = secondary_.facets[place.facet];
    Point at = Point::Zero(), normal = Point::Zero();
    for (std::size_t c = 0; c < corners.size(); ++c) {
      at += place.shape[static_cast<Eigen::Index>(c)] * secondary_.points[static_cast<std::size_t>(corners[c])];
      normal += place.shape[static_cast<Eigen::Index>(c)] * nodes_.normal(secondary_, place.facet, c);
    }
    return {at, normal.normalized()};
  }

  void add_point(std::size_t p, double d, double rise, constraint::Contacts& contacts)
  {
    const SurfaceNode& surface_node = nodes_.all[p];
    const auto [at, own_normal] = point_of(p);
    const Point normal = bonded() ? surface_node.normal : rays_.direction(p, at, own_normal);
    constraint::ContactNode point{
        index_, secondary_.node_id[static_cast<std::size_t>(surface_node.node)], d, normal, {}, contacts.rows.size()};
    if (bonded() && !options_.preload) note_tear(d, normal);
    const bool prescribed = !writer_.moves(terms_, d, normal);  // on both sides
    if (!prescribed && options_.law != Law::frictionless)
      for (const auto& tangent : tangents(p, normal))
        if (writer_.moves(terms_, d, tangent)) point.tangents.push_back(tangent);

    Point separation = Point::Zero();  // of the two sides in the mesh, weighted as the row is
    double weight = 0;
    for (const auto& term : terms_) {
      const Side& side = term.on_primary ? primary_ : secondary_;
      separation -= term.value / d * side.points[static_cast<std::size_t>(term.node)];
      if (!term.on_primary) weight += term.value / d;
    }
    point.weight = weight;
    point.at = at;
    point.cover = cover_[p];
    const double mean = (normal.dot(separation) - rise / d) / weight,
                 mesh_gap = without_rounding(p, gap_at(p, normal, mean), at, normal);
    const double gap = starts_in_mesh() ? mesh_gap : without_rounding(p, starting_gap_at(p, normal, mean), at, normal);
    note_gap(initial_gap_, gap, mesh_gap, one_surface_.anywhere() && gap == 0, d, point.at);
    point.gap = bonded() ? 0 : weight * (gap - options_.interference);
    if (prescribed) {
      if (!bonded()) note_crossing(p, d, normal, point.gap);
      return;
    }
    if (axisymmetric_) {  // rings do not turn
      writer_.add(terms_, d, normal, point.gap, contacts);
      for (const auto& tangent : point.tangents) writer_.add(terms_, d, tangent, 0, contacts);
    } else {
      const Moments moments(terms_, d, normal, bonded() ? 0 : mesh_gap, moved(p) ? &at : nullptr, secondary_, primary_,
                            dimension_);
      writer_.add(terms_, d, normal, point.gap, contacts);
      for (const auto& tangent : point.tangents) writer_.add(terms_, d, tangent, 0, contacts, moments.couple(tangent), normal);
    }
    contacts.nodes.push_back(std::move(point));
    contacts.bonded.push_back(bonded());
  }

  // The tangents of a row's direction: those that supports leave, and where the primary side moves past what they hold, these as
  // well, which it alone feels. In a bond they would hold its mean where the neighbours' rows hold it already, but for faces that
  // have no others. Where both sides are held, as in a plane of symmetry, nothing moves.
  Few<Point, 2> tangents(std::size_t p, const Point& normal)
  {
    Few<Point, 2> result = free_tangents(p, normal);
    if (options_.cyclic || options_.obstacle || (bonded() && !held_through_[p])) return result;
    Few<Point, 2> held;
    if (dimension_ == 2 && result.empty()) held.push_back(Point(-normal[1], normal[0], 0));
    if (dimension_ == 3 && result.size() == 1) held.push_back(normal.cross(result[0]).normalized());
    if (dimension_ == 3 && result.empty())
      for (const auto& tangent : directions(normal, {false, false, false}, {}, 3).tangents) held.push_back(tangent);
    for (const auto& tangent : held)
      if (!primary_held(p, tangent)) result.push_back(tangent);
    return result;
  }

  // Whether supports hold the primary side along a direction where a surface node meets it.
  bool primary_held(std::size_t p, const Point& direction)
  {
    constexpr double none = 1e-6;
    const auto held = [&](Global node) {
      for (int c = 0; c < dimension_; ++c)
        if (std::abs(direction[c]) > none && primary_supports_.find(node, c)) return true;
      const auto skew_supports = primary_supports_.skew_supports(node);
      return std::any_of(skew_supports.begin(), skew_supports.end(),
                         [&](const auto& i) { return std::abs(direction.dot(along(i))) > none; });
    };
    const Opposite& opposite = rays_.meet(p);
    if (!std::isfinite(opposite.gap)) return true;
    const auto nodes = primary_.facets[opposite.facet];
    for (std::size_t k = 0; k < nodes.size(); ++k)
      if (std::abs(opposite.hit.shape[static_cast<Eigen::Index>(k)]) > none &&
          !held(primary_.node_id[static_cast<std::size_t>(nodes[k])]))
        return false;
    return true;
  }

  Few<Point, 2> free_tangents(std::size_t p, const Point& normal) const
  {
    const auto& known = directions_[p].tangents;
    Few<Point, 2> result;
    if (normal == nodes_.all[p].normal) {
      for (const auto& tangent : known) result.push_back(tangent);
      return result;
    }
    const Global node = secondary_.node_id[static_cast<std::size_t>(nodes_.all[p].node)];
    const bool freed = freed_[p];
    const std::array<bool, 3> prescribed{!freed && supports_.find(node, 0), !freed && supports_.find(node, 1),
                                         !freed && supports_.find(node, 2)};
    const auto rotated = directions(
        normal, prescribed, freed ? std::span<const constraint::SkewSupport>{} : supports_.skew_supports(node), dimension_);
    for (const auto& tangent : rotated.tangents) result.push_back(tangent);
    return result;
  }

  // The gap between the smooth surfaces at the point itself, along the direction of contact. Its mean over the dual basis, which
  // has negative parts, would see an overlap of a twelfth of curvature times cell size squared between surfaces that only touch;
  // that mean is left for points that look past the border of the primary side.
  // `gap_of`: what the contact starts with where a line meets something.
  double gap_at(std::size_t p, const Point& direction, double mean, const Rays::GapOf& gap_of = {})
  {
    if (const auto place = nearest_place(p))
      if (const double gap = rays_.gap(p, *place, direction, gap_of); std::isfinite(gap)) return gap;
    std::optional<double> first;  // the mean is taken of what others differ from it: of equals it is exact
    double sum = 0, d = 0, at_node = std::numeric_limits<double>::quiet_NaN();
    for (const auto& [face, i, k] : faces_.at(p)) {
      const auto piece = faces_.piece(i);
      const double part = piece.covered[k];
      if (part == 0) continue;
      double gap = at_node;
      if (!piece.point_facet.empty()) {
        const auto facet = static_cast<std::size_t>(piece.point_facet[static_cast<std::size_t>(k)]);
        gap = rays_.gap(p, {facet, piece.points.row(k).transpose()}, direction, gap_of);
      } else if (std::isnan(gap)) {
        gap = at_node = rays_.gap(p, direction, gap_of);
      }
      if (!first) first = gap;
      d += part;
      sum += part * (gap - *first);
    }
    if (!first || !std::isfinite(*first) || !std::isfinite(sum)) return mean;
    return *first + sum / d;
  }

  // Where nearest_points() put a surface node, in the facet that it lies in: in the others round the node their smooth surface is
  // continued beyond their border.
  std::optional<Rays::FacetPoint> nearest_place(std::size_t p)
  {
    constexpr double rounding = 1e-9;
    if (!moved(p)) return {};
    for (const auto& [face, i, k] : faces_.at(p)) {
      const auto piece = faces_.piece(i);
      if (piece.facet < 0 || piece.point_facet.empty() || piece.point_facet[static_cast<std::size_t>(k)] < 0) continue;
      const auto facet = static_cast<std::size_t>(piece.facet);
      const Eigen::Vector4d shape = shape_beside(secondary_, facet, static_cast<std::size_t>(k), nearest_[p].shift);
      const auto corners = static_cast<Eigen::Index>(secondary_.facets[facet].size());
      if (shape.head(corners).minCoeff() >= -rounding && (piece.points.row(k).transpose() - shape).norm() < rounding)
        return Rays::FacetPoint{facet, shape};
    }
    return {};
  }

  // Of places that coordinates say are the same the gap is 0: bodies that touch without a load press with nothing then. Nor is an
  // overlap where a side comes nearest that is next to nothing of what the sides come nearer there, or of what stands out of a
  // facet: surfaces are known no better.
  double without_rounding(std::size_t p, double gap, const Point& at, const Point& direction)
  {
    constexpr double of_surfaces = 0.02;
    if (gap < 0 && at_nearest_place(p)) {
      if (const double at_node = rays_.meet(p).gap; std::isfinite(at_node) && -gap < of_surfaces * (at_node - gap)) return 0;
      if (!options_.obstacle && -gap < of_surfaces * rays_.rise_of(rays_.met_from(p, at, direction))) return 0;
    }
    return std::abs(gap) < rounding_of_gap * reach_ + rounding_of_coordinates * at.norm() ? 0 : gap;
  }

  bool starts_in_mesh() const { return !options_.clearance && !options_.adjust && !one_surface_.anywhere(); }

  std::size_t face_of(std::size_t facet) const { return static_cast<std::size_t>(primary_.face_of[facet]); }

  // That which the contact starts with; the terms are those of the surface node.
  double starting_gap_at(std::size_t p, const Point& direction, double mean)
  {
    return gap_at(p, direction, starting_gap(options_, mean, one_surface_.holds(p, terms_)),
                  [&](std::size_t surface_node, const Opposite& opposite) {
                    return starting_gap(options_, opposite.gap,
                                        one_surface_.anywhere() && one_surface_.holds(surface_node, face_of(opposite.facet)));
                  });
  }

  const Options& options_;
  int index_;
  double reach_;
  int dimension_;
  bool axisymmetric_;
  const Share& share_;
  const Side &secondary_, &primary_;
  const std::vector<PressedNode>& pressed_nodes_;
  SurfaceNodes nodes_, primary_nodes_;
  CutFaces faces_;  // once dual, those near have their share of the rows
  Tree tree_;       // of the primary facets
  Rays rays_;
  bool mesh_gaps_;
  std::vector<NearestPoint> nearest_;  // of each surface node, or none
  std::optional<OnePart> one_part_;    // once one is asked
  std::unique_ptr<Discretization> discretization_;
  OneSurface one_surface_;
  InitialGap initial_gap_;
  SupportedNodes supports_, primary_supports_;
  RowWriter writer_;
  double crossing_ = 0, tear_ = 0;
  double covered_area_ = 0;
  std::vector<Directions> directions_;  // of each surface node
  std::vector<char> stranded_;          // of each surface node: its faces have no surface node that supports and seams leave free
  std::vector<char> held_through_;      // of each surface node: supports hold a tangent at all nodes of one of its faces
  std::vector<char> freed_;             // of each surface node: its row keeps what supports hold of the secondary side
  std::vector<char> kept_;              // of each surface node
  std::vector<double> cover_;           // of each surface node
  std::vector<Term> terms_;             // of the surface node at work
};

[[noreturn]] void refuse_tear(const Options& options, double tear)
{
  throw Error(
      ExitStatus::bad_input,
      fmt::format("contact {}: supports hold both sides, \"{}\" and \"{}\", and move them {:.3g} apart, which the bond does "
                  "not let them; change one of the supports",
                  options.name, options.secondary, options.primary, tear));
}

[[noreturn]] void refuse_crossing(const Options& options, double crossing)
{
  const auto what =
      options.obstacle
          ? fmt::format("supports hold \"{}\" {:.3g} inside the {}; change the supports or the obstacle", options.secondary,
                        crossing, shape_name(*options.obstacle))
          : fmt::format(
                "supports hold both sides, \"{}\" and \"{}\", and push them {:.3g} into each other; change one of the supports",
                options.secondary, options.primary, crossing);
  throw Error(ExitStatus::bad_input, fmt::format("contact \"{}\": {}", options.name, what));
}

}  // namespace

constraint::Contacts discretize(std::span<const Pair> pairs, std::span<const constraint::PrescribedDof> prescribed,
                                fem::Kinematics kinematics, const Communicator& comm,
                                std::span<const constraint::SkewSupport> skew_supports, std::span<const CurvedFace> curved_faces,
                                std::vector<InitialGap>* initial_gaps)
{
  constraint::Contacts contacts;
  const auto sizes = measure(pairs, comm);
  const SupportDirectory directory(prescribed, skew_supports, comm);
  std::vector<PressedNode> pressed_nodes;  // this rank's nodes by number, not by place; see by_node()
  const CurvedFaces curved(curved_faces, comm);
  if (initial_gaps) initial_gaps->assign(pairs.size(), {});
  const auto add = [&](std::size_t c) {
    const auto& options = pairs[c].options;
    const Share share = share_out(pairs[c], sizes[c], kinematics, comm);
    std::vector<PressedNode> crossed;
    if (options.law == Law::bonded && comm.any(!pressed_nodes.empty()))
      crossed = answer(pressed_nodes, ask(share.secondary.node_id, comm), comm);
    Builder builder(options, share, sizes[c].reach, static_cast<int>(c), directory, crossed, curved, kinematics, comm);
    builder.set_touching(touching_gap(sizes[c].extent, sizes[c].secondary_face));
    builder.add_rows(contacts);
    if (initial_gaps) (*initial_gaps)[c] = over_ranks(builder.initial_gap(), comm);
    if (options.cyclic && options.law == Law::bonded)
      require_one_surface(pairs[c], sizes[c], builder.widest_gap(), builder.covered_area(), comm);
    if (const double crossing = comm.max(builder.crossing()); crossing > 1e-9 * sizes[c].reach)
      refuse_crossing(options, crossing);
    if (const double tear = comm.max(builder.tear()); tear > 1e-9 * sizes[c].reach) refuse_tear(options, tear);
  };
  const auto is_bonded = [](const Pair& pair) { return pair.options.law == Law::bonded; };
  for (std::size_t c = 0; c < pairs.size(); ++c)
    if (!is_bonded(pairs[c])) add(c);
  if (std::none_of(pairs.begin(), pairs.end(), is_bonded)) return contacts;
  for (const auto& point : contacts.nodes) pressed_nodes.push_back({point.node});
  pressed_nodes = by_node<PressedNode>(pressed_nodes, comm);
  for (std::size_t c = 0; c < pairs.size(); ++c)
    if (is_bonded(pairs[c])) add(c);
  return contacts;
}

}  // namespace mortise::contact
