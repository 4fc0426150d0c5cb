// summary.json from what was found and spent.
#pragma once

#include "base/timer.hpp"
#include "base/traffic.hpp"
#include "io/summary.hpp"
#include "output/evaluated_state.hpp"

namespace mortise::output {

/// The sizes of a problem: unknowns, subdomains, clusters, dimension of the kernels. The same on every rank. Collective.
io::Summary sizes_of(const feti::DualSystem& system, const Communicator& comm);
/// The sizes in the text of a summary.json; zeros where it has none.
io::Summary sizes_told(const std::string& json);
/// Copies the sizes alone; the rest of `to` stays.
void copy_sizes(const io::Summary& from, io::Summary& to);

/// The summary of one equilibrium, without version, time, memory and communication. Collective.
io::Summary summarise(const model::Model& model, const EvaluatedState& found, const Communicator& comm);

/// Adds the steps and the work of the states `before` to `summary`, which is that of the state `acts` alone.
void accumulate_steps(const model::LoadState& acts, const io::Summary& before, io::Summary& summary);

/// Fills summary.communication with what ranks sent, `total` in all; what is neither solution nor output counts as set-up. Does
/// nothing in a build that does not count. Collective.
void note_communication(const Timers& timers, const Traffic& total, const Communicator& comm, io::Summary& summary);

}  // namespace mortise::output
