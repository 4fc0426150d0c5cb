// The fields of a run as files.
#pragma once

#include "io/vtk.hpp"
#include "output/evaluated_state.hpp"

namespace mortise::output {

/// The files of one state after the other: solution.pvd, contact.pvd, blocks.pvd and results.h5, and what the deck asks for
/// inside bodies, interior.csv and plane.NAME.pvd. With load steps each state has its own pieces and tables, solution.1_0.vtu or
/// results.1.h5, but for the last tables, which are results.h5, and interior.csv. Refers to the deck.
class FieldFiles {
 public:
  explicit FieldFiles(const model::Deck& deck);
  /// `due`: whether the deck wants the fields of this state; interior.csv has all states. Throws Error(machine) if a file cannot
  /// be written. Collective.
  void write(const EvaluatedState& found, bool due, bool last, const Communicator& comm);

 private:
  void write_fields(const EvaluatedState& found, bool last, const Communicator& comm);
  void write_tables(const EvaluatedState& found, bool last, const Communicator& comm) const;

  const model::Deck& deck_;
  io::Series volume_{"solution", {}}, contact_{"contact", {}}, blocks_{"blocks", {}};
  std::vector<io::Series> planes_;
  std::string points_;  // interior.csv so far
};

}  // namespace mortise::output
