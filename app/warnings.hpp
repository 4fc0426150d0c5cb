// Collects what lib/post and the run itself have to tell of a model and its results.
#pragma once

#include "base/warning.hpp"
#include "report.hpp"

namespace mortise {

/// All warnings of a run. Of several states the worst of each kind and place stays.
class Warnings {
 public:
  void add(Warning warning);
  void add(std::vector<Warning> more)
  {
    for (auto& warning : more) add(std::move(warning));
  }
  /// As it is found: for a run that may not come to its last lines.
  void tell(Warning warning, Log& log);
  const std::vector<Warning>& all() const { return all_; }

 private:
  std::vector<Warning> all_;
};

/// Before the solution: materials, units, contacts. Collective.
std::vector<Warning> check_model(const Deck& deck, const partition::Decomposition& decomposition, const Model& model,
                                 const Simulation& simulation, const Communicator& comm);

/// Of a solution; `results` as evaluate() leaves them. Collective.
std::vector<Warning> check_results(const Deck& deck, const partition::Decomposition& decomposition, const Model& model,
                                   const Simulation& simulation, const Results& results, const Communicator& comm);

/// A contact without a point does nothing: the bodies would pass through each other unnoticed. Collective.
std::vector<Warning> idle_contacts(const constraint::Contacts& contacts, const Deck& deck, const Communicator& comm);

/// The last lines on the terminal.
void print(const Warnings& warnings, Log& log);

}  // namespace mortise
