// What supports and contacts ask of the displacements in one load state: the rows of B and their bounds.
#pragma once

#include <optional>
#include <vector>

#include "constraint/constraints.hpp"
#include "contact/mortar.hpp"
#include "model/model.hpp"

namespace mortise::analysis {

/// A value; one that is shared does not change.
struct Rows {
  model::LoadState acts;                          ///< the state whose rows these are
  std::vector<constraint::Support> supports;      ///< of the deck, as they act in this state
  std::vector<contact::Pair> pairs;               ///< of each contact
  std::vector<contact::InitialGap> initial_gaps;  ///< of each contact, as the mesh lies; the same on every rank
  constraint::Constraints constraints;
};

/// The rows of a state, each on some rank. `shortenings`: of the preloaded contacts in the state before, none in the first.
/// Throws Error(bad_input) for supports, couplings and contacts that contradict each other. Collective.
Rows make_rows(const model::Model& model, const model::LoadState& acts, const std::vector<double>& shortenings,
               const Context& context);

/// The same rows, each on the rank where feti::distribute_rows() wants it. Collective.
Rows place(Rows rows, const model::Model& model, const partition::NodeDirectory& directory,
           const std::vector<double>& shortenings, const Communicator& comm);

/// `rows`, which place() has distributed, with the bounds of a new state `acts`; nothing if that state has other rows.
/// Collective.
std::optional<Rows> with_new_bounds(Rows rows, const model::Model& model, const partition::NodeDirectory& directory,
                                    const model::LoadState& acts, const std::vector<double>& shortenings,
                                    const Communicator& comm);

/// Takes the slip that the rows `from` count from over to the rows `to` of the same contacts, where other components may be
/// prescribed.
void carry_slip(const constraint::Contacts& from, constraint::Contacts& to);

}  // namespace mortise::analysis
