// One contact on its way from faces to rows: integrates the secondary faces over what lies opposite, chooses the surface nodes
// that carry multipliers, and writes the rows of each.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "contact/cyclic.hpp"
#include "contact/mortar.hpp"
#include "gaps/one_surface.hpp"
#include "gaps/spanned_turns.hpp"
#include "gaps/starting_gaps.hpp"
#include "integrals/cut_faces.hpp"
#include "rows/bond_directions.hpp"
#include "rows/bond_owners.hpp"
#include "rows/contact_nodes.hpp"
#include "rows/discretization.hpp"
#include "rows/moments.hpp"
#include "rows/multiplier_points.hpp"
#include "rows/one_part.hpp"
#include "rows/opposite_supports.hpp"
#include "rows/rows.hpp"
#include "rows/rows_between.hpp"
#include "rows/sector_cuts.hpp"
#include "rows/support_conflicts.hpp"
#include "rows/supported_nodes.hpp"
#include "search/line_of_sight.hpp"
#include "search/nearest_points.hpp"
#include "search/opposite.hpp"
#include "search/over_facets.hpp"
#include "search/share.hpp"
#include "surface/continued_side.hpp"

namespace mortise::contact {

// Of a facet's corner, in what lies opposite a node.
inline constexpr double no_part = 1e-6;

// Nodes of a bond's secondary side at which others have rows, ascending.
struct OthersNodes {
  std::vector<Global> of_contacts;  // that are not bonded
  std::vector<Global> of_bonds;     // to which they belong
};

// The rows of one contact at the nodes that are this rank's.
class ContactBuilder {
 public:
  // `others`: nodes of share.secondary at which others have rows, ascending; may be filled until add_rows(). All arguments
  // outlive it. Collective.
  ContactBuilder(const Options& options, const Share& share, double reach, int index, const SupportDirectory& supports,
                 const FacesAtBonds& at_bonds, const OthersNodes& others, const CurvedFaces& curved, fem::Kinematics kinematics,
                 const Communicator& comm)
      : options_(options),
        index_(index),
        reach_(reach),
        dimension_(fem::dimension(kinematics)),
        axisymmetric_(kinematics == fem::Kinematics::axisymmetric),
        share_(share),
        secondary_(share.secondary),
        primary_(share.primary),
        others_(others),
        supports_(supports, secondary_.node_id, comm),
        primary_supports_(supports, primary_.node_id, comm),
        primary_at_bonds_(at_bonds.nodes_of(primary_, comm)),
        nodes_(find_surface_nodes(secondary_, supports_, at_bonds, at_bonds.nodes_of(secondary_, comm))),
        primary_nodes_(find_surface_nodes(primary_, primary_supports_, at_bonds, primary_at_bonds_)),
        faces_(secondary_, nodes_, share.own, options.law == Law::bonded ? 3 : 1),
        tree_(tree_of_facets(primary_)),
        sight_(secondary_, primary_, tree_),
        rays_(secondary_, nodes_, primary_, primary_nodes_, tree_, sight_, options.obstacle, reach),
        mesh_gaps_(options.law != Law::bonded && !options.clearance),
        nearest_(mesh_gaps_ ? find_nearest_points() : std::vector<NearestPoint>()),
        bonded_nodes_(held_together(primary_at_bonds_)),
        discretization_(make_discretization(
            options.discretization,
            {secondary_, nodes_, primary_, primary_nodes_, tree_, sight_, faces_, rays_, options.obstacle.has_value(), reach,
             mesh_gaps_, options.law != Law::bonded, nearest_, bonded_nodes_})),
        one_surface_(asks_geometry(options) ? OneSurface(secondary_, nodes_, primary_, curved, rotation_of(options), comm)
                                            : OneSurface()),
        points_(secondary_, nodes_, faces_, rays_, nearest_),
        gaps_(options, reach, primary_, faces_, rays_, points_, one_surface_),
        opposite_supports_(secondary_, nodes_, primary_, primary_supports_, rays_, dimension_, rotation_of(options)),
        writer_(secondary_, primary_, supports_, primary_supports_, dimension_, rotation_of(options)),
        conflicts_(secondary_, primary_, writer_, dimension_)
  {
  }

  // How the two sides lie on each other, at this rank's surface nodes.
  CutFit fit() const
  {
    CutFit result;
    for (std::size_t p = 0; p < faces_.places(); ++p)
      if (own(p)) result.covered += chosen_.covered[p];
    for (std::size_t p = 0; p < nodes_.all.size(); ++p)
      if (own(p) && chosen_.kept[p]) result.note(std::abs(rays_.gap(p, nodes_.all[p].normal)));
    return result;
  }

  const SupportConflicts& conflicts() const { return conflicts_; }

  // Of this rank's points; `touching`, `face`: see InitialGap.
  const InitialGap& initial_gap() const { return initial_gap_; }
  void set_lengths(double touching, double face) { initial_gap_.touching = touching, initial_gap_.face = face; }

  // What the faces have in common. Collective.
  void integrate(const Communicator& comm)
  {
    const auto cover = [&](std::size_t face) { return discretization_->cover(face); };
    auto between = take_places_between(nearest_, secondary_, nodes_, faces_, share_.own, cover, comm);
    for (const std::size_t f : faces_.round()) discretization_->add_face(f, between.in_facets[f] != 0);
    between_.emplace(std::move(between.places), secondary_, share_.own, comm);
    faces_.number_corners();
    if (bonded()) matches_ = on_matching_faces(secondary_, nodes_, faces_, rays_, share_.own, comm);
  }

  // Of a bond, after integrate(): this rank's secondary nodes that it covers.
  std::vector<CoveredNode> covered_nodes()
  {
    std::vector<CoveredNode> result;
    const auto cover = cover_of_nodes(faces_, nodes_.all.size());
    for (std::size_t p = 0; p < nodes_.all.size(); ++p) {
      if (!own(p) || !(cover[p] > 0)) continue;
      CoveredNode node{node_of(p), index_, matches_[p] != 0, cover[p]};
      node.cyclic = options_.cyclic.has_value();
      node.preloaded = options_.preload.has_value();
      if (const Opposite& opposite = rays_.meet(p); !options_.obstacle && std::isfinite(opposite.gap)) {
        const auto corners = primary_.facets[opposite.facet];
        for (std::size_t k = 0; k < corners.size(); ++k)
          if (opposite.hit.shape[static_cast<Eigen::Index>(k)] > no_part)
            node.opposite[k] = primary_.node_id[static_cast<std::size_t>(corners[k])];
      }
      result.push_back(node);
    }
    return result;
  }

  // The rest of its work, after integrate(): afterwards the others tell what it found.
  void add_rows(constraint::Contacts& contacts, const SupportDirectory& supports)
  {
    const auto one_node = nodes_of_both_sides();
    ends_meet_ = std::ranges::find(one_node, 1) != one_node.end();
    chosen_ =
        choose_contact_nodes(secondary_, nodes_, faces_, supports_, one_node, primary_prescribed(), bonded_nodes(), dimension_);
    if (!options_.preload && !options_.obstacle)
      for (std::size_t p = 0; p < nodes_.all.size(); ++p)
        if (own(p) && !chosen_.kept[p] && chosen_.cover[p] > least_cover) note_conflict_where_prescribed(p);
    if (discretization_->others_take_over())
      for (std::size_t p = 0; p < nodes_.all.size(); ++p)
        if (const auto& n = nodes_.all[p].normal; own(p) && chosen_.shared[p])
          contacts.without_rows.push_back(
              {index_, secondary_.node_id[static_cast<std::size_t>(nodes_.all[p].node)], {n[0], n[1], n[2]}});
    discretization_->make_functions(chosen_.kept);
    faces_.sort_by_nodes();
    for (std::size_t p = 0; p < faces_.places(); ++p)
      if (own(p) && chosen_.kept[p]) add_place(p, contacts);
    if (mesh_gaps_ && !options_.obstacle && !one_surface_.anywhere())
      note_turns(secondary_, nodes_, primary_, primary_nodes_, rays_, initial_gap_);
    // Tresca's bound is an area's, which belongs to the nodes.
    const bool tangents = options_.law != Law::frictionless && options_.law != Law::tresca;
    between_->add_to(contacts, supports, {index_, secondary_.kinematics, rotation_of(options_), tangents},
                     [&](const PlaceBetween& place) { return gap_between(place); });
  }

 private:
  std::vector<NearestPoint> find_nearest_points()
  {
    OverFacets over(secondary_, primary_, primary_nodes_, tree_, sight_, rays_, reach_);
    return nearest_points(secondary_, nodes_, faces_.round(), rays_, over);
  }

  const SurfaceNode& surface_node(std::size_t place) const { return nodes_.all[faces_.surface_node(place)]; }
  bool own(std::size_t place) const { return share_.own[static_cast<std::size_t>(surface_node(place).node)] != 0; }
  bool at_nearest_place(std::size_t p) const { return !nearest_.empty() && !faces_.is_corner(p) && nearest_[p].found; }
  bool bonded() const { return options_.law == Law::bonded; }
  bool ends_together() const { return options_.preload || options_.cyclic || options_.obstacle; }

  Global node_of(std::size_t p) const { return secondary_.node_id[static_cast<std::size_t>(nodes_.all[p].node)]; }

  std::optional<BondedNodes> bonded_nodes()
  {
    if (!bonded()) return {};
    BondedNodes known;
    for (std::size_t p = 0; p < nodes_.all.size(); ++p) {
      const bool met = ends_together() || rays_.meets(p);
      if (!ends_together()) known.met.push_back(met);
      known.left_to_others.push_back(discretization_->seams_end_at_contacts() && belongs_to_others(p, met));
    }
    return known;
  }

  bool belongs_to_others(std::size_t p, bool met) const
  {
    const auto has = [&](const std::vector<Global>& nodes) { return std::ranges::binary_search(nodes, node_of(p)); };
    return has(others_.of_bonds) || (met && has(others_.of_contacts));
  }

  // Of each surface node whether it is a node of the primary side as well, as at the tip of a slit; but none of a face that has
  // no other nodes, for nobody is there to take over.
  std::vector<char> nodes_of_both_sides() const
  {
    std::vector<char> result(nodes_.all.size(), 0);
    if (options_.cyclic || options_.obstacle) return result;
    for (std::size_t p = 0; p < result.size(); ++p) result[p] = writer_.on_both_sides(nodes_.all[p].node);
    if (std::ranges::find(result, 1) == result.end()) return result;
    for (std::size_t f = 0; f < secondary_.faces.size(); ++f) {
      const auto face = secondary_.faces[f];
      if (!std::ranges::all_of(face, [&](Local n) { return writer_.on_both_sides(n); })) continue;
      for (std::size_t p = 0; p < result.size(); ++p)
        if (std::ranges::find(face, nodes_.all[p].node) != face.end()) result[p] = 0;
    }
    return result;
  }

  // Contact may push along a part of a normal that supports leave free. What is bonded to an obstacle has nothing to ask for
  // supports.
  std::vector<char> primary_prescribed()
  {
    if (options_.obstacle) return std::vector<char>(nodes_.all.size(), bonded() ? 1 : 0);
    return opposite_supports_.prescribed_along_normals(
        faces_, bonded() ? &OppositeSupports::prescribe : &OppositeSupports::prescribe_all);
  }

  void note_conflict_where_prescribed(std::size_t p)
  {
    const Local node = nodes_.all[p].node;
    const Point& normal = nodes_.all[p].normal;
    if (bonded())
      conflicts_.note_prescribed_tear(node, normal, rays_.meet(p));
    else if (!chosen_.directions[p].free_normal)
      conflicts_.note_prescribed_crossing(node, normal, rays_.meet(p), chosen_.directions[p]);
  }

  void add_place(std::size_t p, constraint::Contacts& contacts)
  {
    terms_.clear();
    double d = 0, rise = 0;
    for (const auto& function : faces_.at(p)) {
      d += faces_.piece(function.piece).covered[function.k];
      rise += discretization_->rise(function);
      discretization_->add_terms(function, terms_);
    }
    if (!(d > 0)) return;
    merge_terms(terms_);
    if (at_nearest_place(p) && !options_.obstacle) take_one_part(p);
    add_node(p, d, rise, contacts);
  }

  // What is nearest there may be one of several bodies that the functions see.
  void take_one_part(std::size_t p)
  {
    const auto [at, normal] = points_.at(p);
    const auto met = rays_.met_from(p, at, normal);
    if (!std::isfinite(met.gap)) return;
    if (!one_part_) one_part_.emplace(primary_);
    one_part_->take(met, terms_);
  }

  // The contact node of a surface node and its rows; `d`, `rise`: integrals of its functions and of what surfaces bulge.
  void add_node(std::size_t p, double d, double rise, constraint::Contacts& contacts)
  {
    const SurfaceNode& node_here = surface_node(p);
    const auto [at, own_normal] = points_.at(p);
    const Point across = bonded() ? node_here.normal : rays_.direction(faces_.surface_node(p), at, own_normal);
    if (bonded() && !options_.preload) conflicts_.note_tear(terms_, d, across);
    const bool prescribed = !writer_.moves(terms_, d, across);  // on both sides
    const auto bond =
        bonded() && !prescribed ? bond_directions(writer_, terms_, across, !options_.obstacle, dimension_) : std::nullopt;
    const Point& normal = bond ? bond->normal : across;
    constraint::ContactNode node{
        index_, secondary_.node_id[static_cast<std::size_t>(node_here.node)], d, normal, {}, contacts.rows.size()};
    Few<Point, 2> prescribed_tangents;  // tangents along which supports hold both
    if (!prescribed && options_.law != Law::frictionless) {
      const auto along = bond ? bond->tangents : tangents(p, normal);
      for (const auto& tangent : writer_.across_axis(node_here.node, normal, along))
        if (writer_.moves(terms_, d, tangent)) node.tangents.push_back(tangent);
      if (!bonded()) {
        writer_.leave_what_moves(terms_, normal, node.tangents);
        const auto others = other_tangents(normal, node.tangents, dimension_);
        for (const auto& tangent : writer_.across_axis(node_here.node, normal, others))
          if (writer_.prescribed_on_both_sides(terms_, tangent)) prescribed_tangents.push_back(tangent);
      }
    }

    Point separation = Point::Zero();  // of the two sides in the mesh, weighted as the row is
    double weight = 0;
    for (const auto& term : terms_) {
      const Side& side = term.on_primary ? primary_ : secondary_;
      separation -= term.value / d * side.points[static_cast<std::size_t>(term.node)];
      if (!term.on_primary) weight += term.value / d;
    }
    node.weight = weight;
    node.at = at;
    const double room = points_.room(p);
    node.cover = room < 1 ? std::min(chosen_.cover[p], 0.5 * room) : chosen_.cover[p];
    const double mean = (normal.dot(separation) - rise / d) / weight;
    const auto [mesh_gap, gap] = gaps_.at_node(p, at_nearest_place(p), at, normal, mean, terms_);
    note_gap(initial_gap_, gap, mesh_gap, gaps_.by_geometry(gap), d * weight, node.at);
    node.gap = bonded() ? 0 : weight * (gap - options_.interference);
    node.prescribed_share = bonded() ? 0 : prescribed_on_both_sides(normal);
    if (!bonded() && (prescribed || writer_.part_that_moves(terms_, d, normal) < hardly_moves))
      conflicts_.note_crossing(terms_, d, normal, node.gap, chosen_.directions[p], prescribed && chosen_.stranded[p]);
    if (prescribed) return;
    if (axisymmetric_) {  // rings do not turn
      writer_.add(terms_, d, normal, constraint::bound_of(node), contacts);
      for (const auto& tangent : node.tangents) writer_.add(terms_, d, tangent, 0, contacts);
    } else {
      const Moments moments(terms_, d, normal, bonded() ? 0 : mesh_gap, points_.moved(p) ? &at : nullptr, secondary_, primary_,
                            dimension_);
      writer_.add(terms_, d, normal, constraint::bound_of(node), contacts);
      for (const auto& tangent : node.tangents) writer_.add(terms_, d, tangent, 0, contacts, moments.couple(tangent), normal);
    }
    for (const auto& tangent : prescribed_tangents) {
      writer_.add_prescribed(terms_, d, tangent, contacts);
      node.tangents.push_back(tangent);
    }
    for (const auto& tangent : bond ? bond->of_primary : Few<Point, 2>()) {
      writer_.add(terms_, d, tangent, 0, contacts);
      node.tangents.push_back(tangent);
    }
    between_->note(node, points_.means_field(p), terms_, d, secondary_, primary_);
    contacts.nodes.push_back(std::move(node));
    contacts.bonded.push_back(bonded());
  }

  // Part of the row: that of the side of which supports hold less.
  double prescribed_on_both_sides(const Point& normal) const
  {
    if (options_.obstacle || (!ends_meet_ && (supports_.empty() || primary_supports_.empty()))) return 0;
    return std::clamp(1 - std::max(writer_.freedom(terms_, false, normal), writer_.freedom(terms_, true, normal)), 0.0, 1.0);
  }

  // The tangents of a row's direction: those that supports leave, and where the primary side moves past what they hold, these as
  // well, which it alone feels. Where both sides are held, as in a plane of symmetry, nothing moves.
  Few<Point, 2> tangents(std::size_t p, const Point& normal)
  {
    Few<Point, 2> result = free_tangents(p, normal);
    if (options_.obstacle) return result;
    const auto others = other_tangents(normal, result, dimension_);
    if (others.empty()) return result;
    const Opposite opposite = opposite_of(p);
    for (const auto& tangent : others)
      if (!opposite_supports_.prescribe(opposite, tangent)) result.push_back(tangent);
    return result;
  }

  // What lies opposite a place's multiplier, which past the border of the primary side stands beside its node.
  Opposite opposite_of(std::size_t p)
  {
    const auto node = faces_.surface_node(p);
    const Opposite& at_node = rays_.meet(node);
    return std::isfinite(at_node.gap) ? at_node : rays_.met_from(node, points_.at(p).first, nodes_.all[node].normal);
  }

  Few<Point, 2> free_tangents(std::size_t p, const Point& normal) const
  {
    const auto& known = chosen_.directions[p].tangents;
    Few<Point, 2> result;
    if (normal == surface_node(p).normal) {
      for (const auto& tangent : known) result.push_back(tangent);
      return result;
    }
    const Global node = secondary_.node_id[static_cast<std::size_t>(surface_node(p).node)];
    const bool freed = chosen_.freed[p];
    const std::array<bool, 3> prescribed{!freed && supports_.find(node, 0), !freed && supports_.find(node, 1),
                                         !freed && supports_.find(node, 2)};
    const auto rotated = directions(
        normal, prescribed, freed ? std::span<const constraint::SkewSupport>{} : supports_.skew_supports(node), dimension_);
    for (const auto& tangent : rotated.tangents) result.push_back(tangent);
    return result;
  }

  RowsBetween::Gap gap_between(const PlaceBetween& place)
  {
    const Point direction = rays_.direction(place.surface_node, place.at, rays_.own_normal(place.where));
    const auto [mesh, gap] = gaps_.between_nodes(place, direction);
    if (std::isfinite(gap)) note_gap(initial_gap_, gap, mesh, gaps_.by_geometry(gap), 0, place.at);
    return {direction, mesh, gap - options_.interference};
  }

  const Options& options_;
  int index_;
  double reach_;
  int dimension_;
  bool axisymmetric_;
  const Share& share_;
  const Side &secondary_, &primary_;
  const OthersNodes& others_;
  SupportedNodes supports_, primary_supports_;
  std::vector<FacesAtBonds::AtBond> primary_at_bonds_;
  SurfaceNodes nodes_, primary_nodes_;
  CutFaces faces_;  // once dual, those near have their share of the rows
  Tree tree_;
  LineOfSight sight_;  // of the primary facets
  Rays rays_;
  bool mesh_gaps_;
  std::vector<NearestPoint> nearest_;  // of each surface node, or none
  std::optional<OnePart> one_part_;    // once one is asked
  std::optional<RowsBetween> between_;
  std::vector<std::vector<Local>> bonded_nodes_;  // of the primary side
  std::unique_ptr<Discretization> discretization_;
  OneSurface one_surface_;
  InitialGap initial_gap_;
  MultiplierPoints points_;
  StartingGaps gaps_;
  OppositeSupports opposite_supports_;
  RowWriter writer_;
  SupportConflicts conflicts_;
  ContactNodes chosen_;
  bool ends_meet_ = false;     // some nodes are on both sides
  std::vector<Term> terms_;    // of the surface node at work
  std::vector<char> matches_;  // of each surface node of a bond: all nodes of its faces lie opposite nodes
};

}  // namespace mortise::contact
