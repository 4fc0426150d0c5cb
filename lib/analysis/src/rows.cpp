#include "analysis/rows.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <optional>
#include <tuple>

#include "constraint/coupling.hpp"
#include "constraint/normals.hpp"
#include "constraint/pretension.hpp"
#include "constraint/right_hand_sides.hpp"
#include "constraint/supports.hpp"
#include "contact/cyclic.hpp"
#include "feti/row_distribution.hpp"
#include "model/curved_faces.hpp"
#include "same_nodes.hpp"

namespace mortise::analysis {

namespace {

// Of each preloaded contact with nodes on both cuts of a sector, as of a bolt on its axis, that axis; the same on every rank.
// Half a bolt at one cut is drawn along itself. Collective.
std::vector<std::optional<Point>> axes_of_sectors(const Rows& rows, const Communicator& comm)
{
  enum Side { secondary, primary, none };  // of a cut
  struct AtNode {
    Global node;
    int contact;
    Side side;
  };
  std::vector<std::vector<AtNode>> send(static_cast<std::size_t>(comm.size()));
  const auto tell = [&](Global node, std::size_t contact, Side side) {
    send[static_cast<std::size_t>(node) % static_cast<std::size_t>(comm.size())].push_back(
        {node, static_cast<int>(contact), side});
  };
  for (std::size_t c = 0; c < rows.pairs.size(); ++c) {
    const auto& [options, own, opposite] = rows.pairs[c];
    if (!options.cyclic && !options.preload) continue;
    for (const Global node : own.node_id) tell(node, c, options.cyclic ? secondary : none);
    if (!opposite) continue;
    for (const Global node : opposite->node_id) tell(node, c, options.cyclic ? primary : none);
  }
  std::vector<AtNode> all;
  for (const auto& part : comm.exchange(send)) all.insert(all.end(), part.begin(), part.end());
  std::ranges::sort(all, {}, [](const AtNode& at) { return std::tuple(at.node, at.side, at.contact); });
  std::vector<std::array<long long, 2>> cut_at(rows.pairs.size(), {-1, -1});  // by the sides of the cut
  for (auto begin = all.begin(); begin != all.end();) {
    const auto end = std::find_if(begin, all.end(), [&](const AtNode& at) { return at.node != begin->node; });
    for (auto own = begin; own != end; ++own)
      for (auto cut = begin; own->side == none && cut != end && cut->side != none; ++cut)
        cut_at[static_cast<std::size_t>(own->contact)][cut->side] = cut->contact;
    begin = end;
  }
  for (auto& sides : cut_at)
    for (auto& cut : sides) cut = comm.max(cut);
  std::vector<std::optional<Point>> result(rows.pairs.size());
  for (std::size_t c = 0; c < result.size(); ++c)
    if (std::ranges::min(cut_at[c]) >= 0) {
      const auto& cut = rows.pairs[static_cast<std::size_t>(cut_at[c].front())].options;
      result[c] = Eigen::AngleAxisd(contact::rotation_of(cut)->rotation).axis();
    }
  return result;
}

void find_pretension_sections(const model::Model& model, const std::vector<double>& shortenings, const Communicator& comm,
                              Rows& rows)
{
  const auto preloads = model::preloads(model.contacts(), rows.acts, shortenings);
  if (preloads.empty()) return;
  const auto axes = axes_of_sectors(rows, comm);
  const auto axis_of = [&](const constraint::Preload& preload) -> std::optional<Point> {
    if (model.deck().axisymmetric()) return Point(Point::UnitY());
    return axes[static_cast<std::size_t>(preload.contact)];
  };
  rows.constraints.pretension_sections =
      constraint::find_pretension_sections(rows.constraints.contacts, preloads, model.deck().dimension(), axis_of, comm);
}

// What supports and rigid couplings prescribe, but for unknown motions.
std::vector<constraint::PrescribedDof> prescribed_components(const model::Model& model,
                                                             std::span<const constraint::Support> supports,
                                                             std::span<const constraint::Coupling> couplings,
                                                             std::vector<constraint::PrescribedDof> aligned,
                                                             const Communicator& comm)
{
  const int dimension = model.deck().dimension();
  if (!couplings.empty()) {
    const auto coupled = constraint::coupled_rows(couplings, model.coupling_surfaces(), model.first_coupling(), dimension, comm);
    aligned.insert(aligned.end(), coupled.begin(), coupled.end());
  }
  return constraint::dirichlet_rows(supports, model.support_nodes(supports, comm), dimension, comm, aligned);
}

// Along normals and local axes, ascending by node.
std::vector<constraint::NodeDirection> held_directions(const model::Model& model, std::span<const constraint::Support> supports,
                                                       const Communicator& comm)
{
  auto all = constraint::node_normals(supports, model.support_surfaces(), comm);
  if (std::none_of(supports.begin(), supports.end(), [](const auto& s) { return s.axes.has_value(); })) return all;
  const auto along_axes = constraint::axes_directions(supports, model.support_nodes(supports, comm), model.deck().dimension(),
                                                      model.rounding(comm), comm);
  all.insert(all.end(), along_axes.begin(), along_axes.end());
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.node < b.node; });
  return all;
}

// Rows of contacts keep their entries at nodes of couplings whose motion is unknown.
std::vector<constraint::PrescribedDof> known_components(std::vector<constraint::PrescribedDof> prescribed)
{
  std::erase_if(prescribed, [](const constraint::PrescribedDof& h) { return h.unknown; });
  return prescribed;
}

}  // namespace

Rows make_rows(const model::Model& model, const model::LoadState& acts, const std::vector<double>& shortenings,
               const Context& context)
{
  const auto scope = context.timers.scope("contact");
  const auto& comm = context.comm;
  const auto& deck = model.deck();
  Rows rows{acts, model.supports(acts), model.contact_pairs(acts), {}, {}};
  auto directions = held_directions(model, rows.supports, comm);
  const auto aligned = constraint::take_axis_aligned(directions);
  auto& constraints = rows.constraints;
  constraints.couplings = model.couplings(acts, comm);
  constraints.mean_motions = model.mean_motions(constraints.couplings, comm);
  constraints.springs = model.springs(acts, comm);
  constraints.prescribed = prescribed_components(model, rows.supports, constraints.couplings, aligned, comm);
  constraint::require_consistent(constraints.mean_motions, constraints.prescribed, constraints.couplings, comm);
  constraints.skew_supports = constraint::skew_support_rows(rows.supports, directions, constraints.prescribed, comm);
  constraints.contacts =
      contact::discretize(rows.pairs, known_components(constraints.prescribed), deck.kinematics, comm, constraints.skew_supports,
                          model::curved_faces(deck, model.decomposition(), rows.pairs), &rows.initial_gaps);
  find_pretension_sections(model, shortenings, comm, rows);
  return rows;
}

Rows place(Rows rows, const model::Model& model, const partition::NodeDirectory& directory,
           const std::vector<double>& shortenings, const Communicator& comm)
{
  const auto& decomposition = model.decomposition();
  auto& constraints = rows.constraints;
  constraints.prescribed = feti::distribute_rows(constraints.prescribed, decomposition, directory, comm);
  constraints.skew_supports = feti::distribute_rows(constraints.skew_supports, decomposition, directory, comm);
  constraints.contacts = feti::distribute_rows(constraints.contacts, decomposition, directory, comm);
  constraints.springs.own = feti::rows_here(constraints.springs.rows, decomposition, directory, comm);
  find_pretension_sections(model, shortenings, comm, rows);
  return rows;
}

std::optional<Rows> with_new_bounds(Rows rows, const model::Model& model, const partition::NodeDirectory& directory,
                                    const model::LoadState& acts, const std::vector<double>& shortenings,
                                    const Communicator& comm)
{
  const auto& deck = model.deck();
  for (std::size_t i = 0; i < deck.supports.size(); ++i)
    if (deck.supports[i].stiffness.any() && acts.acting[i] != rows.acts.acting[i]) return {};
  auto supports = model.supports(acts);
  const bool moved = !std::equal(supports.begin(), supports.end(), rows.supports.begin());
  auto couplings = model.couplings(acts, comm);
  if (!constraint::same_unknowns(couplings, rows.constraints.couplings)) return {};
  if (moved || !couplings.empty()) {
    // What is prescribed along normals may stand in many rows.
    if (std::any_of(deck.supports.begin(), deck.supports.end(), [](const auto& s) { return s.normal || !s.axes.empty(); }))
      return {};
    auto mean_motions = model.mean_motions(couplings, comm);
    auto components = prescribed_components(model, supports, couplings, {}, comm);
    constraint::require_consistent(mean_motions, components, couplings, comm);
    auto prescribed = feti::distribute_rows(std::move(components), model.decomposition(), directory, comm);
    if (!constraint::update_rhs(rows.constraints, std::move(prescribed), supports, rows.supports, comm)) return {};
    rows.constraints.mean_motions = std::move(mean_motions);
    rows.constraints.couplings = std::move(couplings);
  }
  const auto& contacts = model.contacts();
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const double overlap = (acts.contact[c] - rows.acts.contact[c]) * contacts[c].interference;
    if (overlap != 0) constraint::add_interference(rows.constraints.contacts, static_cast<int>(c), overlap);
    rows.pairs[c].options.interference += overlap;
  }
  rows.supports = std::move(supports);
  rows.acts = acts;
  find_pretension_sections(model, shortenings, comm, rows);
  return rows;
}

void carry_slip(const constraint::Contacts& from, constraint::Contacts& to)
{
  if (from.slipped.empty()) return;
  to.slipped.assign(to.rows.size(), 0.0);
  const auto old = index(from);
  for (const auto& [key, i] : index(to)) {
    const auto found = old.find(key);
    if (found == old.end()) continue;
    const auto &a = from.nodes[found->second], &b = to.nodes[i];
    const auto take = [&](std::size_t t, double slip) {
      to.slipped[b.row + 1 + t] = slip;
      to.rows.bound[b.row + 1 + t] += slip;
    };
    // What a row without entries gave way by is slip once the node is let go.
    for (const bool prescribed : {true, false})
      change_tangents(
          a, b,
          [&](std::size_t t) {
            const auto row = a.row + 1 + t;
            return from.slipped[row] - (!prescribed && from.rows[row].empty() ? from.rows.bound[row] : 0);
          },
          [&](std::size_t t, double slip) {
            if (to.rows[b.row + 1 + t].empty() == prescribed) take(t, slip);
          });
  }
}

}  // namespace mortise::analysis
