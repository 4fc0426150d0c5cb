// summary.json from what was found and spent.
#pragma once

#include "base/timer.hpp"
#include "base/traffic.hpp"
#include "io/summary.hpp"
#include "output/evaluated_state.hpp"

namespace mortise::output {

/// Of the problem that is solved. Collective.
io::Summary sizes_of(const partition::Decomposition& decomposition, const feti::DualProblem& problem, const Communicator& comm);
/// Those that a summary.json tells; zeros where it does not.
io::Summary sizes_told(const std::string& json);
/// Unknowns, subdomains, clusters and dimension of the kernels; the rest of `to` stays.
void copy_sizes(const io::Summary& from, io::Summary& to);

/// One equilibrium; nothing of the program's version, of time, memory and communication. Collective.
io::Summary summarise(const model::Model& model, const EvaluatedState& found, const Communicator& comm);

/// Adds the steps and the work of the states `before` to `summary`, which is that of the state `acts` alone.
void accumulate_steps(const model::LoadState& acts, const io::Summary& before, io::Summary& summary);

/// What ranks sent, `total` in all: what is neither solution nor output sets up. Nothing in a build that does not
/// count. Collective.
void note_communication(const Timers& timers, const Traffic& total, const Communicator& comm, io::Summary& summary);

}  // namespace mortise::output
