// The lines on the terminal, for an engineer to judge a run by.
#pragma once

#include "analysis/memory.hpp"
#include "analysis/rows.hpp"
#include "analysis/warnings.hpp"
#include "feti/subdomain_operator.hpp"
#include "io/summary.hpp"
#include "post/balance.hpp"
#include "post/verdict.hpp"

namespace mortise {

/// What is going to be solved.
void print_header(const model::Deck& deck, const model::Contacts& contacts, const partition::Decomposition& decomposition,
                  const Context& context);
/// --check: how large the problem is. Collective.
void print_check(const model::Model& model, const constraint::Constraints& constraints, const analysis::Memory& memory,
                 const Context& context);
/// How many subdomains share factors. Collective.
void print_copies(const std::vector<partition::CopyOf>& copies, const partition::Decomposition& decomposition,
                  const Context& context);
/// How many factors are in single precision, if any are. Collective.
void print_precision(const std::vector<partition::CopyOf>& copies, const feti::Subdomains& subdomains, const Context& context);
/// Which state is being solved, where there are several. `seconds_left`: for this one and those after it; 0: not known.
void print_state(const model::LoadState& state, std::size_t index, std::size_t count, double seconds_left, Log& log);
/// After a load step that is not the last.
void print_step(const io::Summary& summary, Log& log);
/// After the last load step: forces, stresses, contacts, residuals.
void print_results(const post::Verdict& verdict, const post::Balance& balance, const io::Summary& summary, Log& log);
/// A line for each probe; nothing without.
void print_probes(const io::StateSummary& summary, Log& log);
/// What the rank that sends most has sent; nothing on one rank, or where the build does not count.
void print_communication(const io::Summary& summary, Log& log);
/// Seconds of each stage over the ranks.
void print_times(const std::vector<Timers::Spread>& spreads, Log& log);
/// The last lines of a run: all warnings.
void print_warnings(const analysis::Warnings& warnings, Log& log);

}  // namespace mortise
