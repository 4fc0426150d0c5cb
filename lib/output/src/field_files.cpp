#include "output/field_files.hpp"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "base/error.hpp"
#include "io/files.hpp"
#include "output/blocks.hpp"
#include "output/contact_pressure.hpp"
#include "output/contact_sides.hpp"
#include "output/sections.hpp"
#include "output/tables.hpp"
#include "output/volume.hpp"

namespace mortise::output {

namespace {

// What the deck asks for at nodes beside displacements and stresses. Collective.
std::vector<NodeValues> values_of_nodes(const model::Deck& deck, const EvaluatedState& found, const Communicator& comm)
{
  std::vector<NodeValues> result;
  if (deck.output.has_field("reaction_force"))
    result.push_back(
        {"reaction_force", 3,
         post::holding_forces(found.state.problem, found.decomposition, found.interface, found.state.solved.solution.x)});
  if (deck.output.has_field("contact_pressure"))
    result.push_back(
        {"contact_pressure", 1,
         contact_pressure(found.decomposition, found.interface, found.state.rows->pairs, found.results.contact.surfaces, comm)});
  return result;
}

}  // namespace

FieldFiles::FieldFiles(const model::Deck& deck) : deck_(deck), points_(point_header(deck))
{
  for (const auto& [name, plane] : deck.output.interior.planes) planes_.push_back({"plane." + name, {}});
}

void FieldFiles::write(const EvaluatedState& found, bool due, bool last, const Communicator& comm)
{
  if (due) write_fields(found, last, comm);
  if (!deck_.output.interior.any_points()) return;
  points_ += point_rows(found.decomposition.catalogue, found.acts(), found.probes, found.results.fields.interior.points, comm);
  collectively(comm, [&] {
    if (comm.root()) io::write_text(deck_.output.directory + "/interior.csv", points_);
  });
}

void FieldFiles::write_fields(const EvaluatedState& found, bool last, const Communicator& comm)
{
  const auto& [decomposition, interface, state, probes, results] = found;
  const auto& directory = deck_.output.directory;
  const auto& pairs = state.rows->pairs;
  const auto time = deck_.steps.empty() ? std::nullopt : std::optional(found.acts().time);
  const auto put = [&](io::Series& series, const io::Piece& piece) {
    if (time)
      io::write_vtk(directory, series, *time, piece, comm);
    else
      io::write_vtk(directory, series.name, piece, comm);
  };
  write_tables(found, last, comm);
  const auto sides = contact_sides(pairs, results.contact.surfaces);
  if (!pairs.empty()) put(contact_, sides);
  const auto volume = make_volume(deck_, decomposition, state.displacement, results.fields, values_of_nodes(deck_, found, comm));
  put(volume_, volume.piece);
  if (wants_blocks(deck_, decomposition.catalogue, pairs.size()))
    io::write_blocks(directory, blocks_, time, named_blocks(deck_, decomposition, pairs, results.fields.stress, volume, sides),
                     comm);
  for (std::size_t k = 0; k < planes_.size(); ++k)
    put(planes_[k], plane_piece(deck_, decomposition, probes.planes[k], results.fields.interior.planes[k]));
}

// Before the fields of the same state.
void FieldFiles::write_tables(const EvaluatedState& found, bool last, const Communicator& comm) const
{
  auto tables = node_tables(found.decomposition, found.interface, found.state.displacement, found.results.fields.stress);
  const auto append = [&](std::vector<io::Table> more) {
    for (auto& table : more) tables.push_back(std::move(table));
  };
  append(cell_tables(found.decomposition, found.results.fields.stress, comm));
  tables.push_back(multiplier_table(found.state.problem, found.state.solved.solution.x));
  if (!found.state.rows->pairs.empty()) tables.push_back(contact_table(found.results.contact.shown, comm));
  append(interior_tables(found.decomposition, found.probes, found.results.fields.interior, comm));
  const auto name = last ? std::string("results.h5") : fmt::format("results.{}.h5", volume_.frames.size() + 1);
  io::write_results(deck_.output.directory + "/" + name, tables, comm);
}

}  // namespace mortise::output
