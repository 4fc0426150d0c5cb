#include "rows/contact_rows.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "gaps/one_surface.hpp"
#include "gaps/spanned_turns.hpp"
#include "gaps/starting_gaps.hpp"
#include "rows/bond_directions.hpp"
#include "rows/contact_nodes.hpp"
#include "rows/moments.hpp"
#include "rows/multiplier_points.hpp"
#include "rows/one_part.hpp"
#include "rows/opposite_supports.hpp"
#include "rows/rows.hpp"
#include "rows/shares_beside_supports.hpp"

namespace mortise::contact {

namespace {

// The rows of one contact at work. What lies beside them, before any row is written.
class ContactRows {
 public:
  ContactRows(IntegratedContact& contact, const OthersNodes& others, const InitialGap& gap, const CurvedFaces& curved,
              const Communicator& comm)
      : s_(*contact.sides),
        between_(contact.between),
        matches_(contact.matches),
        one_surface_(asks_geometry(s_.options)
                         ? OneSurface(s_.secondary, s_.nodes, s_.primary, curved, rotation_of(s_.options), comm)
                         : OneSurface()),
        points_(s_.secondary, s_.nodes, s_.faces, s_.rays, s_.nearest),
        gaps_(s_.options, s_.reach, s_.primary, s_.faces, s_.rays, points_, one_surface_),
        opposite_supports_(s_.secondary, s_.nodes, s_.primary, s_.primary_supports, s_.rays, s_.dimension,
                           rotation_of(s_.options)),
        writer_(s_.secondary, s_.primary, s_.supports, s_.primary_supports, s_.dimension, rotation_of(s_.options)),
        conflicts_(s_.secondary, s_.primary, writer_, s_.dimension),
        initial_gap_(gap),
        on_both_sides_(s_.options.cyclic || s_.options.obstacle ? std::vector<char>(s_.nodes.all.size(), 0)
                                                                : nodes_of_both_sides(s_.secondary, s_.nodes, s_.primary)),
        ends_meet_(std::ranges::find(on_both_sides_, 1) != on_both_sides_.end()),
        chosen_(choose_contact_nodes(s_.secondary, s_.nodes, s_.faces, s_.supports, on_both_sides_, primary_prescribed(),
                                     bonded_nodes(others), s_.dimension))
  {
  }
  ContactRows(const ContactRows&) = delete;
  ContactRows& operator=(const ContactRows&) = delete;

  // Once. Collective.
  void add_to(constraint::Contacts& contacts, const SupportDirectory& supports)
  {
    if (!options().preload && !options().obstacle)
      for (std::size_t p = 0; p < s_.nodes.all.size(); ++p)
        if (own(p) && !chosen_.kept[p] && chosen_.cover[p] > least_cover) note_conflict_where_prescribed(p);
    if (s_.discretization->others_take_over())
      for (std::size_t p = 0; p < s_.nodes.all.size(); ++p)
        if (const auto& n = s_.nodes.all[p].normal; own(p) && chosen_.shared[p])
          contacts.without_rows.push_back({s_.index, s_.node_of(p), {n[0], n[1], n[2]}, node_opposite(p)});
    given_ = shares_beside_supports();
    s_.discretization->make_functions(chosen_.kept);
    given_.take_functions(s_.faces);
    s_.faces.sort_by_nodes();
    for (std::size_t p = 0; p < s_.faces.places(); ++p)
      if (own(p) && chosen_.kept[p]) add_contact_node(p, contacts);
    if (s_.mesh_gaps && !options().obstacle && !one_surface_.anywhere())
      note_turns(s_.secondary, s_.nodes, s_.primary, s_.primary_nodes, s_.rays, initial_gap_);
    // Tresca's bound is an area's, which belongs to the nodes.
    const bool tangents = options().law != Law::frictionless && options().law != Law::tresca;
    between_.add_to(contacts, supports, {s_.index, s_.secondary.kinematics, rotation_of(options()), tangents},
                    [&](const ContactPoint& place) { return gap_between(place); });
  }

  RowsFound found() const { return {initial_gap_, options().cyclic ? fit() : CutFit(), conflicts_.found()}; }

 private:
  // How the two sides lie on each other, at this rank's surface nodes.
  CutFit fit() const
  {
    CutFit result;
    for (std::size_t p = 0; p < s_.faces.places(); ++p)
      if (own(p)) result.covered += chosen_.covered[p];
    for (std::size_t p = 0; p < s_.nodes.all.size(); ++p)
      if (own(p) && chosen_.kept[p]) result.note(std::abs(s_.rays.gap(p, s_.nodes.all[p].normal)));
    return result;
  }

  const SurfaceNode& surface_node(std::size_t place) const { return s_.nodes.all[s_.faces.surface_node(place)]; }
  bool own(std::size_t place) const { return s_.own(place); }
  bool at_nearest_place(std::size_t p) const { return !s_.nearest.empty() && !s_.faces.is_corner(p) && s_.nearest[p].found; }
  bool bonded() const { return s_.bonded(); }
  const Options& options() const { return s_.options; }
  bool ends_together() const { return options().preload || options().cyclic || options().obstacle; }

  // Of a bond both of whose sides supports hold, each by itself.
  SharesBesideSupports shares_beside_supports()
  {
    const bool alone = options().obstacle || options().cyclic || s_.supports.empty() || s_.primary_supports.empty();
    if (!bonded() || alone || !s_.discretization->others_take_over()) return {};
    const SharesBesideSupports::OnPrimary on_primary{
        [&](std::size_t p, const Point& axis) {
          return !matches_[p] && s_.rays.meets(p) && opposite_supports_.prescribe(s_.rays.meet(p), axis);
        },
        [&](std::size_t p, const Point& at, const Point& axis) {
          const auto met = s_.rays.met_from(p, at, s_.nodes.all[p].normal);
          return std::isfinite(met.gap) && opposite_supports_.prescribe(met, axis);
        },
        [&](Local node, const Point& axis) { return opposite_supports_.prescribe_node(node, axis); }};
    return {s_.secondary, s_.nodes, s_.faces, s_.supports, chosen_.kept, on_primary, s_.dimension};
  }

  std::optional<BondedNodes> bonded_nodes(const OthersNodes& others)
  {
    if (!bonded()) return {};
    BondedNodes known;
    for (std::size_t p = 0; p < s_.nodes.all.size(); ++p) {
      const bool met = ends_together() || s_.rays.meets(p);
      if (!ends_together()) known.met.push_back(met);
      known.left_to_others.push_back(s_.discretization->seams_end_at_contacts() && belongs_to_others(p, met, others));
    }
    return known;
  }

  bool belongs_to_others(std::size_t p, bool met, const OthersNodes& others) const
  {
    const auto has = [&](const std::vector<Global>& nodes) { return std::ranges::binary_search(nodes, s_.node_of(p)); };
    return has(others.of_bonds) || (met && has(others.of_contacts));
  }

  // Contact may push along a part of a normal that supports leave free. What is bonded to an obstacle has nothing to ask for
  // supports.
  std::vector<char> primary_prescribed()
  {
    if (options().obstacle) return std::vector<char>(s_.nodes.all.size(), bonded() ? 1 : 0);
    if (!bonded())
      return opposite_supports_.prescribed(s_.faces, [&](std::size_t p, const Opposite& opposite) {
        return opposite_supports_.prescribe_all(opposite, s_.nodes.all[p].normal);
      });
    const Few<Point, 3> axes{Point::UnitX(), Point::UnitY(), Point::UnitZ()};
    return opposite_supports_.prescribed(s_.faces, [&](std::size_t p, const Opposite& opposite) {
      constexpr double alike = 0.1;
      const Eigen::Matrix3d free = s_.supports.free_part(s_.node_of(p), s_.dimension);
      // A pair of nodes stays one along what one of them moves alone. At cuts of a sector also along what both move: the push
      // along the normal that passes into supports there acts on the ends of one and the same support, and makes no resultant.
      if (matches_[p]) {
        if (options().cyclic && free.trace() > nothing_moves) return false;
        return (free - opposite_supports_.free_part(opposite)).norm() < alike;
      }
      const auto directions = directions_of_most(Eigen::Matrix3d::Identity() - free, axes, 0.5);
      return opposite_supports_.prescribe_each(opposite, directions);
    });
  }

  // The primary side's node opposite one of a bond on faces whose nodes lie opposite nodes; else -1.
  Global node_opposite(std::size_t p)
  {
    if (matches_.empty() || !matches_[p] || options().obstacle) return -1;
    const Opposite& opposite = s_.rays.meet(p);
    if (!std::isfinite(opposite.gap)) return -1;
    const auto corners = s_.primary.facets[opposite.facet];
    Eigen::Index corner = 0;
    opposite.hit.shape.head(static_cast<Eigen::Index>(corners.size())).maxCoeff(&corner);
    return s_.primary.node_id[static_cast<std::size_t>(corners[static_cast<std::size_t>(corner)])];
  }

  void note_conflict_where_prescribed(std::size_t p)
  {
    const Local node = s_.nodes.all[p].node;
    const Point& normal = s_.nodes.all[p].normal;
    if (bonded())
      conflicts_.note_prescribed_tear(node, normal, s_.rays.meet(p));
    else if (!chosen_.directions[p].free_normal)
      conflicts_.note_prescribed_crossing(node, normal, s_.rays.meet(p), chosen_.directions[p]);
  }

  void add_contact_node(std::size_t p, constraint::Contacts& contacts)
  {
    terms_.clear();
    double d = 0, rise = 0;
    for (const auto& function : s_.faces.at(p)) {
      d += s_.faces.piece(function.piece).covered[function.k];
      rise += s_.discretization->rise(function);
      s_.discretization->add_terms(function, terms_);
    }
    if (!(d > 0)) return;
    merge_terms(terms_);
    if (at_nearest_place(p) && !options().obstacle) take_one_part(p);
    add_node(p, d, rise, contacts);
  }

  // What is nearest there may be one of several bodies that the functions see.
  void take_one_part(std::size_t p)
  {
    const auto [at, normal] = points_.at(p);
    const auto met = s_.rays.met_from(p, at, normal);
    if (!std::isfinite(met.gap)) return;
    if (!one_part_) one_part_.emplace(s_.primary);
    one_part_->take(met, terms_);
  }

  // The contact node of a surface node and its rows; `d`, `rise`: integrals of its functions and of what surfaces bulge.
  void add_node(std::size_t p, double d, double rise, constraint::Contacts& contacts)
  {
    const SurfaceNode& node_here = surface_node(p);
    const auto [at, own_normal] = points_.at(p);
    const Point across = bonded() ? node_here.normal : s_.rays.direction(s_.faces.surface_node(p), at, own_normal);
    if (bonded() && !options().preload) conflicts_.note_tear(terms_, d, across);
    auto bond = bonded() ? bond_directions(writer_, terms_, across, freedom_of_primary(p), s_.dimension) : std::nullopt;
    if (bond) bond->normal = given_.rest_of(s_.faces.surface_node(p), bond->normal);
    const bool prescribed = !writer_.moves(terms_, d, bond ? bond->normal : across);  // on both sides
    const Point& normal = bond ? bond->normal : across;
    constraint::ContactNode node{
        s_.index, s_.secondary.node_id[static_cast<std::size_t>(node_here.node)], d, normal, {}, contacts.rows.size()};
    const auto prescribed_tangents =
        prescribed || options().law == Law::frictionless ? Few<Point, 2>() : add_tangents(p, bond, node);
    const auto [weight, separation] = sides_of_row(d);
    node.weight = weight;
    node.at = at;
    const double room = points_.room(p);
    node.cover = room < 1 ? std::min(chosen_.cover[p], 0.5 * room) : chosen_.cover[p];
    const double mean = (normal.dot(separation) - rise / d) / weight;
    const auto [mesh_gap, gap] = gaps_.at_node(p, at_nearest_place(p), at, normal, mean, terms_);
    node.in_surface = bond && bond->in_surface;
    if (bonded()) node.across = across;
    if (node.in_surface) {  // what it shows are its neighbours
      contacts.without_rows.push_back({s_.index, node.node, {across[0], across[1], across[2]}});
    } else {
      note_gap(initial_gap_, gap, mesh_gap, gaps_.by_geometry(gap), d * weight, node.at);
    }
    node.gap = bonded() ? 0 : weight * (gap - options().interference);
    node.prescribed_share = bonded() ? 0 : prescribed_on_both_sides(normal);
    if (!bonded() && (prescribed || writer_.part_that_moves(terms_, d, normal) < hardly_moves))
      conflicts_.note_crossing(terms_, d, normal, node.gap, chosen_.directions[p], prescribed && chosen_.stranded[p]);
    if (prescribed) return;
    write(p, node, d, Moments::across(bonded() ? 0 : mesh_gap, normal, own_normal), points_.moved(p) ? &at : nullptr, contacts);
    for (const auto& tangent : prescribed_tangents) {
      writer_.add_prescribed(terms_, d, tangent, contacts);
      node.tangents.push_back(tangent);
    }
    for (const auto& tangent : bond ? bond->of_primary : Few<Point, 2>()) {
      if (given_.gives(s_.faces.surface_node(p), tangent)) continue;
      writer_.add(terms_, d, tangent, 0, contacts, given_.to(p, d, tangent));
      node.tangents.push_back(tangent);
    }
    between_.note(node, points_.means_field(p), terms_, d, s_.secondary, s_.primary);
    contacts.nodes.push_back(std::move(node));
    contacts.bonded.push_back(bonded());
  }

  // See bond_directions().
  std::optional<double> freedom_of_primary(std::size_t p) const
  {
    constexpr double of_pair = 0.01, of_mean = 0.5;
    return options().obstacle                                             ? std::optional<double>()
           : !s_.faces.is_corner(p) && matches_[s_.faces.surface_node(p)] ? of_pair
                                                                          : of_mean;
  }

  // Of a node whose direction is known: appends its tangents. Returns those along which supports hold both sides.
  Few<Point, 2> add_tangents(std::size_t p, const std::optional<BondDirections>& bond, constraint::ContactNode& node)
  {
    Few<Point, 2> prescribed;
    const Local here = surface_node(p).node;
    const auto along = bond ? bond->tangents : tangents(p, node.normal);
    for (const auto& tangent : writer_.across_axis(here, node.normal, along))
      if (writer_.moves(terms_, node.area, tangent)) node.tangents.push_back(tangent);
    if (bonded()) return prescribed;
    writer_.leave_what_moves(terms_, node.normal, node.tangents);
    const auto others = other_tangents(node.normal, node.tangents, s_.dimension);
    for (const auto& tangent : writer_.across_axis(here, node.normal, others)) {
      const auto on_both = writer_.prescribed_on_both_sides(terms_, node.normal, tangent);
      if (on_both) on_both->moves ? node.tangents.push_back(on_both->axis) : prescribed.push_back(on_both->axis);
    }
    return prescribed;
  }

  // The sum of the row's coefficients on the secondary side, and how far the sides are apart in the mesh, weighted as the row is.
  std::pair<double, Point> sides_of_row(double d) const
  {
    Point separation = Point::Zero();
    double weight = 0;
    for (const auto& term : terms_) {
      const Side& side = term.on_primary ? s_.primary : s_.secondary;
      separation -= term.value / d * side.points[static_cast<std::size_t>(term.node)];
      if (!term.on_primary) weight += term.value / d;
    }
    return {weight, separation};
  }

  // The rows along the normal and the tangents, with the moments that these pass on.
  void write(std::size_t p, const constraint::ContactNode& node, double d, const Point& closing, const Point* moved,
             constraint::Contacts& contacts)
  {
    if (s_.axisymmetric) {  // rings do not turn
      writer_.add(terms_, d, node.normal, constraint::bound_of(node), contacts, given_.to(p, d, node.normal));
      for (const auto& tangent : node.tangents) writer_.add(terms_, d, tangent, 0, contacts, given_.to(p, d, tangent));
      return;
    }
    const Moments moments(terms_, d, node.normal, closing, moved, s_.secondary, s_.primary, s_.dimension);
    writer_.add(terms_, d, node.normal, constraint::bound_of(node), contacts, given_.to(p, d, node.normal));
    for (const auto& tangent : node.tangents) {
      const auto couple = moments.couple(tangent);
      auto couples = given_.to(p, d, tangent);
      if (!couple.empty()) couples.push_back({couple, node.normal});
      writer_.add(terms_, d, tangent, 0, contacts, couples);
    }
  }

  // Part of the row: that of the side of which supports hold less.
  double prescribed_on_both_sides(const Point& normal) const
  {
    if (options().obstacle || (!ends_meet_ && (s_.supports.empty() || s_.primary_supports.empty()))) return 0;
    return std::clamp(1 - std::max(writer_.freedom(terms_, false, normal), writer_.freedom(terms_, true, normal)), 0.0, 1.0);
  }

  // The tangents of a row's direction: those that supports leave, and where the primary side moves past what they hold, these as
  // well, which it alone feels. Where both sides are held, as in a plane of symmetry, nothing moves.
  Few<Point, 2> tangents(std::size_t p, const Point& normal)
  {
    Few<Point, 2> result = free_tangents(p, normal);
    if (options().obstacle) return result;
    const auto others = other_tangents(normal, result, s_.dimension);
    if (others.empty()) return result;
    const Opposite opposite = opposite_of(p);
    for (const auto& tangent : others)
      if (!opposite_supports_.prescribe(opposite, tangent)) result.push_back(tangent);
    return result;
  }

  // What lies opposite a place's multiplier, which past the border of the primary side stands beside its node.
  Opposite opposite_of(std::size_t p)
  {
    const auto node = s_.faces.surface_node(p);
    const Opposite& at_node = s_.rays.meet(node);
    return std::isfinite(at_node.gap) ? at_node : s_.rays.met_from(node, points_.at(p).first, s_.nodes.all[node].normal);
  }

  Few<Point, 2> free_tangents(std::size_t p, const Point& normal) const
  {
    const auto& known = chosen_.directions[p].tangents;
    Few<Point, 2> result;
    if (normal == surface_node(p).normal) {
      for (const auto& tangent : known) result.push_back(tangent);
      return result;
    }
    const Global node = s_.secondary.node_id[static_cast<std::size_t>(surface_node(p).node)];
    const bool freed = chosen_.freed[p];
    const std::array<bool, 3> prescribed{!freed && s_.supports.find(node, 0), !freed && s_.supports.find(node, 1),
                                         !freed && s_.supports.find(node, 2)};
    const auto rotated = directions(
        normal, prescribed, freed ? std::span<const constraint::SkewSupport>{} : s_.supports.skew_supports(node), s_.dimension);
    for (const auto& tangent : rotated.tangents) result.push_back(tangent);
    return result;
  }

  RowsBetween::Gap gap_between(const ContactPoint& place)
  {
    const Point own_normal = s_.rays.own_normal(place.where);
    const Point direction = s_.rays.direction(place.surface_node, place.at, own_normal);
    const auto [mesh, gap] = gaps_.between_nodes(place, direction);
    if (std::isfinite(gap)) note_gap(initial_gap_, gap, mesh, gaps_.by_geometry(gap), 0, place.at);
    return {direction, mesh, gap - options().interference, own_normal};
  }

  OpposedSides& s_;
  RowsBetween& between_;
  const std::vector<char>& matches_;  // see IntegratedContact
  OneSurface one_surface_;
  MultiplierPoints points_;
  StartingGaps gaps_;
  OppositeSupports opposite_supports_;
  RowWriter writer_;
  SupportConflicts conflicts_;
  InitialGap initial_gap_;
  const std::vector<char> on_both_sides_;  // see nodes_of_both_sides()
  const bool ends_meet_;                   // some nodes are
  const ContactNodes chosen_;
  std::optional<OnePart> one_part_;  // once one is asked
  SharesBesideSupports given_;
  std::vector<Term> terms_;  // of the surface node at work
};

}  // namespace

RowsFound add_rows(IntegratedContact contact, const OthersNodes& others, const InitialGap& gap, const SupportDirectory& supports,
                   const CurvedFaces& curved, constraint::Contacts& contacts, const Communicator& comm)
{
  ContactRows rows(contact, others, gap, curved, comm);
  rows.add_to(contacts, supports);
  return rows.found();
}

}  // namespace mortise::contact
