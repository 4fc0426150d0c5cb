// What was found by the deck's `output.probes`: for the summary, and as tables.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "io/summary.hpp"
#include "model/model.hpp"
#include "post/results.hpp"

namespace mortise::output {

/// What the probes found in one state, in the order of their names. Collective.
std::vector<io::StateSummary::Probe> probe_summaries(const model::Deck& deck, const mesh::Catalogue& catalogue,
                                                     const post::Probes& probes, const post::Fields& fields,
                                                     const Communicator& comm);

/// probes.csv, with a row for each state, and probe.NAME.csv of each path, with a row for each of its points in each state. Where
/// two bodies meet a path has a row for either; outside all bodies it has one without values.
class ProbeFiles {
 public:
  /// Refers to the deck.
  explicit ProbeFiles(const model::Deck& deck) : deck_(deck) {}
  /// Adds a state, with what probe_summaries() says of it and `sampled`, see post::Interior, and writes the files. Throws
  /// Error(machine) if one cannot be written. Collective.
  void write(const mesh::Catalogue& catalogue, const model::LoadState& acts, const post::Probes& probes,
             const post::Values& sampled, const std::vector<io::StateSummary::Probe>& summaries, const Communicator& comm);

 private:
  void add_row(const model::LoadState& acts, const std::vector<io::StateSummary::Probe>& summaries);

  const model::Deck& deck_;
  std::string table_;                         // probes.csv so far
  std::map<std::string, std::string> paths_;  // the other files so far
};

}  // namespace mortise::output
