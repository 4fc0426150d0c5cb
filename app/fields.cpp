#include "fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "base/error.hpp"
#include "contact_pressure.hpp"
#include "fem/quantity.hpp"
#include "interior.hpp"
#include "io/files.hpp"
#include "io/results.hpp"
#include "io/vtk.hpp"
#include "local_fields.hpp"
#include "model/patterns.hpp"

namespace mortise {

namespace {

// What is shown of a subdomain: of boundary elements the cells inside, if they were asked for.
const mesh::Mesh& shown(const partition::Subdomain& subdomain, const post::Results& results)
{
  return results.interior.nodes.empty() ? subdomain.mesh : post::solid(subdomain);
}

// Of a cell among those that are shown; bodies of boundary elements have one material.
std::size_t block_of(const partition::Subdomain& subdomain, const post::Results& results, std::size_t s, std::size_t cell)
{
  return subdomain.skin || results.stress.cell_block.empty() ? 0 : static_cast<std::size_t>(results.stress.cell_block[s][cell]);
}

// The points of the volume's mesh: the nodes and, where stresses jump between materials, one for each material that meets there.
// Point (n, k) of a subdomain stands at n * materials + k.
std::vector<bool> points_of(const partition::Subdomain& subdomain, const post::Results& results, std::size_t s,
                            std::size_t materials)
{
  const auto& mesh = shown(subdomain, results);
  if (materials == 1) return std::vector<bool>(mesh.node_count(), true);
  std::vector<bool> used(mesh.node_count() * materials, false);
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    for (const Local n : mesh.cells[c]) used[static_cast<std::size_t>(n) * materials + block_of(subdomain, results, s, c)] = true;
  return used;
}

// The subdomains of this rank as one mesh, in which the copies of a node are one; `ids` of its points are numbers of nodes times
// `materials`, plus that of the material, ascending.
struct Volume {
  io::Piece piece;
  std::size_t materials = 1;
  std::vector<Global> ids;
};

Volume volume_piece(const model::Deck& deck, const partition::Decomposition& decomposition, const std::vector<Eigen::VectorXd>& u,
                    const std::vector<Eigen::MatrixXd>& holding, const std::vector<Eigen::MatrixXd>& pressing,
                    const post::Results& results)
{
  io::Piece piece;
  const bool with_principal = wanted(deck, "principal_stress");
  const auto materials =
      results.stress.by_material.empty() ? 1 : static_cast<std::size_t>(results.stress.by_material.front().cols()) / 6;
  Volume result{{}, materials, {}};
  auto& ids = result.ids;
  std::vector<std::vector<bool>> used;
  for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
    const auto& mesh = shown(decomposition.subdomains[s], results);
    used.push_back(points_of(decomposition.subdomains[s], results, s, materials));
    for (std::size_t i = 0; i < used[s].size(); ++i)
      if (used[s][i])
        ids.push_back(mesh.node_id[i / materials] * static_cast<Global>(materials) + static_cast<Global>(i % materials));
  }
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  const auto count = ids.size();
  const int dimension = decomposition.catalogue.dimension;
  piece.points.resize(count);
  io::Field displacement{"displacement", 3, std::vector<double>(3 * count, 0.0)},
      von_mises{"von_mises", 1, std::vector<double>(count)}, stress{"stress", 6, std::vector<double>(6 * count)},
      principal{"principal_stress", 3, std::vector<double>(with_principal ? 3 * count : 0)},
      reaction{"reaction_force", 3, std::vector<double>(holding.empty() ? 0 : 3 * count, 0.0)},
      pressure{"contact_pressure", 1, std::vector<double>(pressing.empty() ? 0 : count, 0.0)};
  LocalFields local(deck, count);
  io::Field cell_von_mises{"von_mises", 1, {}}, body{"body", 1, {}, true}, owner{"subdomain", 1, {}, true};
  for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
    const auto& subdomain = decomposition.subdomains[s];
    const auto& mesh = shown(subdomain, results);
    const auto on_mesh = subdomain.mesh.node_count();  // the nodes after these are inside a skin
    const auto& nodal = materials == 1 ? results.stress.nodal[s] : results.stress.by_material[s];
    std::vector<Local> place(used[s].size(), -1);
    for (std::size_t i = 0; i < used[s].size(); ++i) {
      if (!used[s][i]) continue;
      const std::size_t n = i / materials, block = i % materials;
      const Global id = mesh.node_id[n] * static_cast<Global>(materials) + static_cast<Global>(block);
      const auto at = static_cast<std::size_t>(std::lower_bound(ids.begin(), ids.end(), id) - ids.begin());
      place[i] = static_cast<Local>(at);
      piece.points[at] = mesh.points[n];
      const auto row = static_cast<Eigen::Index>(n < on_mesh ? n : n - on_mesh);
      Point moved = Point::Zero();
      fem::Stress own;
      if (n < on_mesh) {
        moved.head(dimension) = u[s].segment(dimension * row, dimension);
        own = nodal.row(row).segment(6 * static_cast<Eigen::Index>(block), 6).transpose();
      } else {
        moved = results.interior.nodes[s].displacement.row(row).transpose();
        own = results.interior.nodes[s].stress.row(row).transpose();
      }
      for (std::size_t c = 0; c < 3; ++c) displacement.values[3 * at + c] = moved[static_cast<Eigen::Index>(c)];
      von_mises.values[at] = fem::von_mises(own);
      local.set(at, mesh.points[n], moved, own);
      for (std::size_t c = 0; c < 6; ++c) stress.values[6 * at + c] = own[static_cast<Eigen::Index>(c)];
      if (with_principal) Eigen::Map<Eigen::Vector3d>(&principal.values[3 * at]) = fem::principal_stresses(own);
      if (!pressing.empty() && n < on_mesh) pressure.values[at] = pressing[s](row, 0);
      if (!holding.empty() && n < on_mesh) Eigen::Map<Eigen::RowVector3d>(&reaction.values[3 * at]) = holding[s].row(row);
    }
    const auto& of_cells = &mesh == &subdomain.mesh ? results.stress.cell_von_mises[s] : results.interior.cell_von_mises[s];
    for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
      const auto block = block_of(subdomain, results, s, c);
      std::vector<Local> nodes;
      for (const Local n : mesh.cells[c]) nodes.push_back(place[static_cast<std::size_t>(n) * materials + block]);
      piece.cells.add(mesh.cells.type[c], nodes);
      cell_von_mises.values.push_back(of_cells[static_cast<Eigen::Index>(c)]);
      body.values.push_back(subdomain.body);
      owner.values.push_back(static_cast<double>(subdomain.id));
    }
  }
  if (wanted(deck, "displacement")) piece.point_fields.push_back(std::move(displacement));
  if (wanted(deck, "von_mises")) {
    piece.point_fields.push_back(std::move(von_mises));
    piece.cell_fields.push_back(std::move(cell_von_mises));
  }
  if (wanted(deck, "stress")) piece.point_fields.push_back(std::move(stress));
  if (with_principal) piece.point_fields.push_back(std::move(principal));
  local.move_to(piece);
  if (wanted(deck, "reaction_force")) piece.point_fields.push_back(std::move(reaction));
  if (wanted(deck, "contact_pressure")) piece.point_fields.push_back(std::move(pressure));
  piece.cell_fields.push_back(std::move(body));
  piece.cell_fields.push_back(std::move(owner));
  result.piece = std::move(piece);
  return result;
}

void append(std::vector<double>& to, const Point& p)
{
  to.insert(to.end(), {p[0], p[1], p[2]});
}

// The gaps of a secondary side; at nodes too far from the other side to have one the largest of the faces round them.
std::vector<double> gaps_shown(const mesh::Surface& surface, const contact::SurfaceState& state)
{
  std::vector<double> result = state.gap;
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    double largest = 0;
    for (const Local n : surface.faces[f])
      if (const auto i = static_cast<std::size_t>(n); state.near[i]) largest = std::max(largest, state.gap[i]);
    for (const Local n : surface.faces[f])
      if (const auto i = static_cast<std::size_t>(n); !state.near[i]) result[i] = std::max(result[i], largest);
  }
  return result;
}

// The secondary sides of all contacts: faces with a node that lies near enough to the other side to have a state.
io::Piece contact_piece(const std::vector<contact::Pair>& pairs, const std::vector<contact::SurfaceState>& states)
{
  io::Piece piece;
  io::Field pressure{"contact_pressure", 1, {}}, recovered{"contact_pressure_recovered", 1, {}},
      traction{"contact_traction", 3, {}}, gap{"gap", 1, {}}, slip{"slip", 3, {}}, status{"contact_status", 1, {}, true},
      index{"contact", 1, {}, true};
  std::vector<std::string> names;
  std::vector<std::size_t> shown;
  for (std::size_t c = 0; c < pairs.size(); ++c) {
    names.push_back(fmt::format("{}: {}", c, pairs[c].options.name));
    const auto& surface = pairs[c].secondary;
    const auto& near = states[c].near;
    const auto base = static_cast<Local>(piece.points.size());
    piece.points.insert(piece.points.end(), surface.points.begin(), surface.points.end());
    for (std::size_t f = 0; f < surface.faces.size(); ++f) {
      std::vector<Local> nodes(surface.faces[f].begin(), surface.faces[f].end());
      if (std::any_of(nodes.begin(), nodes.end(), [&](Local n) { return near[static_cast<std::size_t>(n)] != 0; }))
        shown.push_back(piece.cells.size());
      for (auto& n : nodes) n += base;
      piece.cells.add(surface.faces.type[f], nodes);
      index.values.push_back(static_cast<double>(c));
    }
    const auto gaps = gaps_shown(surface, states[c]);
    gap.values.insert(gap.values.end(), gaps.begin(), gaps.end());
    for (std::size_t n = 0; n < surface.points.size(); ++n) {
      pressure.values.push_back(states[c].pressure[n]);
      recovered.values.push_back(states[c].recovered_pressure[n]);
      append(traction.values, states[c].traction[n]);
      append(slip.values, states[c].slip[n]);
      status.values.push_back(states[c].status[n]);
    }
  }
  piece.point_fields = {pressure, recovered, traction, gap, slip, status};
  piece.cell_fields = {index};
  piece.words = {{"contact_status: words", {"0: open", "1: sticks, or closed without friction", "2: slips"}},
                 {"contact: names", std::move(names)}};
  return io::part_of(piece, shown);
}

// The cells of a piece by their values in one of its cell fields, which are numbers from 0 on.
std::vector<std::vector<std::size_t>> cells_by(const io::Piece& piece, const std::string& field, std::size_t count)
{
  std::vector<std::vector<std::size_t>> result(count);
  for (const auto& f : piece.cell_fields)
    if (f.name == field)
      for (std::size_t c = 0; c < f.values.size(); ++c) result[static_cast<std::size_t>(f.values[c])].push_back(c);
  return result;
}

// The boundaries that supports, loads and couplings name, once each.
std::vector<std::string> boundaries_in_use(const model::Deck& deck)
{
  std::vector<std::string> names;
  const auto add = [&](const std::string& name) {
    if (!name.empty() && std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  };
  for (const auto& support : deck.supports) add(support.boundary);
  for (const auto& load : deck.loads) add(load.boundary);
  for (const auto& [name, coupling] : deck.couplings) add(coupling.boundary);
  return names;
}

// The faces of a boundary, with the point fields of the volume.
io::Piece boundary_piece(const std::string& name, const partition::Decomposition& decomposition, const post::Results& results,
                         const Volume& volume)
{
  const auto [boundary, body] = model::parse_boundary(name);
  const auto& catalogue = decomposition.catalogue;
  const auto index = std::find(catalogue.boundaries.begin(), catalogue.boundaries.end(), boundary) - catalogue.boundaries.begin();
  io::Piece faces;
  faces.points = volume.piece.points;
  faces.point_fields = volume.piece.point_fields;
  std::vector<std::size_t> all;
  for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
    const auto& subdomain = decomposition.subdomains[s];
    const auto& facets = subdomain.mesh.facets;
    const bool meant = body.empty() || model::matches_name(catalogue.bodies[static_cast<std::size_t>(subdomain.body)], body);
    for (std::size_t f = 0; meant && f < facets.cells.size(); ++f) {
      if (facets.boundary[f] != index) continue;
      const auto block = volume.materials == 1 ? 0 : block_of(subdomain, results, s, static_cast<std::size_t>(facets.parent[f]));
      std::vector<Local> nodes;
      for (const Local n : facets.cells[f]) {
        const Global id = subdomain.mesh.node_id[static_cast<std::size_t>(n)] * static_cast<Global>(volume.materials) +
                          static_cast<Global>(block);
        nodes.push_back(static_cast<Local>(std::lower_bound(volume.ids.begin(), volume.ids.end(), id) - volume.ids.begin()));
      }
      all.push_back(all.size());
      faces.cells.add(facets.cells.type[f], nodes);
    }
  }
  return io::part_of(faces, all);
}

// The parts of the model by name.
std::vector<io::Block> named_blocks(const model::Deck& deck, const partition::Decomposition& decomposition,
                                    const analysis::Rows& rows, const post::Results& results, const Volume& volume,
                                    const io::Piece& contacts)
{
  std::vector<io::Block> blocks;
  const auto& bodies = decomposition.catalogue.bodies;
  const auto of_bodies = cells_by(volume.piece, "body", bodies.size());
  for (std::size_t b = 0; b < bodies.size(); ++b)
    blocks.push_back({"bodies", bodies[b].name, io::part_of(volume.piece, of_bodies[b])});
  const auto of_contacts = cells_by(contacts, "contact", rows.pairs.size());
  for (std::size_t c = 0; c < rows.pairs.size(); ++c)
    blocks.push_back({"contacts", rows.pairs[c].options.name, io::part_of(contacts, of_contacts[c])});
  for (const auto& name : boundaries_in_use(deck))
    blocks.push_back({"boundaries", name, boundary_piece(name, decomposition, results, volume)});
  return blocks;
}

// Nodal tables: each node from its lowest copy.
std::vector<io::Table> node_tables(const partition::Decomposition& decomposition, const partition::Interface& interface,
                                   const std::vector<Eigen::VectorXd>& displacement, const post::Results& results)
{
  const Global total = decomposition.catalogue.node_count;
  const int dimension = decomposition.catalogue.dimension;
  std::vector<io::Table> tables{{"nodes/points", "coordinates", 3, total, {}, {}},
                                {"nodes/displacement", "displacement", 3, total, {}, {}},
                                {"nodes/von_mises", "von Mises stress, recovered inside the body", 1, total, {}, {}},
                                {"nodes/stress", "XX YY ZZ XY YZ XZ, recovered inside the body", 6, total, {}, {}}};
  for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
    const auto& subdomain = decomposition.subdomains[s];
    std::size_t shared = 0;
    for (std::size_t n = 0; n < subdomain.mesh.node_count(); ++n) {
      if (shared < interface.nodes[s].size() && interface.nodes[s][shared] == static_cast<Local>(n)) {
        if (interface.copies[s][shared++][0].subdomain != subdomain.id) continue;
      }
      for (auto& table : tables) table.row.push_back(subdomain.mesh.node_id[n]);
      append(tables[0].values, subdomain.mesh.points[n]);
      Point u = Point::Zero();
      u.head(dimension) = displacement[s].segment(static_cast<Eigen::Index>(n) * dimension, dimension);
      append(tables[1].values, u);
      tables[2].values.push_back(results.stress.nodal_von_mises[s][static_cast<Eigen::Index>(n)]);
      for (Eigen::Index c = 0; c < 6; ++c) tables[3].values.push_back(results.stress.nodal[s](static_cast<Eigen::Index>(n), c));
    }
  }
  return tables;
}

// Connectivity and what belongs to cells; of boundary elements the cells are the panels.
std::vector<io::Table> cell_tables(const partition::Decomposition& decomposition, const post::Results& results,
                                   const Communicator& comm)
{
  std::vector<const mesh::Mesh*> meshes;
  const Global total = decomposition.catalogue.cell_count;
  io::Table body{"cells/body", "number of the cell's body, from 0, as in body_names of summary.json", 1, total, {}, {}},
      von_mises{"cells/von_mises", "von Mises stress, mean of the cell", 1, total, {}, {}};
  for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
    const auto& subdomain = decomposition.subdomains[s];
    const auto& mesh = subdomain.mesh;
    const auto& stress = results.stress.cell_von_mises[s];
    meshes.push_back(&mesh);
    body.values.insert(body.values.end(), mesh.cells.size(), static_cast<double>(subdomain.body));
    von_mises.values.insert(von_mises.values.end(), stress.begin(), stress.end());
    for (auto* table : {&body, &von_mises}) table->row.insert(table->row.end(), mesh.cell_id.begin(), mesh.cell_id.end());
  }
  auto tables = io::cell_tables(meshes, total, comm);
  tables.push_back(std::move(body));
  tables.push_back(std::move(von_mises));
  return tables;
}

// Rows by contact and node whatever ranks they come from; at a kink two points share a node.
io::Table contact_table(const post::Results& results, const Communicator& comm)
{
  const auto& points = results.contact.points;
  using Key = std::array<double, 5>;
  std::vector<Key> own;
  for (const auto& p : points)
    own.push_back({static_cast<double>(p.contact), static_cast<double>(p.node), p.area, p.gap, static_cast<double>(comm.rank())});
  auto all = comm.all_gather(own);
  std::sort(all.begin(), all.end());
  std::map<Key, Global> repeated;
  io::Table table{
      "contact/points",
      "contact, node, area, normal force, force on the secondary side (3), gap, slip (3), status 0 open 1 stick 2 slip",
      12,
      static_cast<Global>(all.size()),
      {},
      {}};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& p = points[i];
    table.row.push_back(std::lower_bound(all.begin(), all.end(), own[i]) - all.begin() + repeated[own[i]]++);
    table.values.insert(table.values.end(), {static_cast<double>(p.contact), static_cast<double>(p.node), p.area, p.force});
    append(table.values, p.force_on_secondary);
    table.values.push_back(p.gap);
    append(table.values, p.slip);
    table.values.push_back(static_cast<double>(static_cast<int>(p.status)));
  }
  return table;
}

io::Table multiplier_table(const feti::DualProblem& problem, const Vector& lambda)
{
  io::Table table{"dual/multipliers",
                  "multipliers of the scaled rows: gluing, supports, contacts, gauges",
                  1,
                  problem.dual_unknowns(),
                  {},
                  {}};
  const auto values = view(lambda);
  const auto rows = problem.jump().rows()->getNodeElementList();
  table.row.assign(rows.begin(), rows.end());
  table.values.assign(values.data(), values.data() + values.size());
  return table;
}

}  // namespace

FieldFiles::FieldFiles(const model::Deck& deck) : deck_(deck), points_(point_header(deck))
{
  for (const auto& [name, plane] : deck.output.interior.planes) planes_.push_back({"plane." + name, {}});
}

void FieldFiles::write(const partition::Decomposition& decomposition, const partition::Interface& interface,
                       const feti::DualProblem& problem, const analysis::StepState& state, const post::Probes& probes,
                       const post::Results& results, bool due, bool last, const Communicator& comm)
{
  const auto& directory = deck_.output.directory;
  if (due) write_fields(decomposition, interface, problem, state, probes, results, last, comm);
  if (!deck_.output.interior.any_points()) return;
  points_ += point_rows(deck_, decomposition.catalogue, state.rows->acts, probes, results.interior.points, comm);
  collectively(comm, [&] {
    if (comm.root()) io::write_text(directory + "/interior.csv", points_);
  });
}

void FieldFiles::write_fields(const partition::Decomposition& decomposition, const partition::Interface& interface,
                              const feti::DualProblem& problem, const analysis::StepState& state, const post::Probes& probes,
                              const post::Results& results, bool last, const Communicator& comm)
{
  const auto& directory = deck_.output.directory;
  const auto& pairs = state.rows->pairs;
  auto tables = node_tables(decomposition, interface, state.displacement, results);
  for (auto& table : cell_tables(decomposition, results, comm)) tables.push_back(std::move(table));
  tables.push_back(multiplier_table(problem, state.solved.solution.x));
  if (!pairs.empty()) tables.push_back(contact_table(results, comm));
  for (auto& table : interior_tables(decomposition, probes, results, comm)) tables.push_back(std::move(table));
  io::write_results(directory + (last ? "/results.h5" : fmt::format("/results.{}.h5", volume_.frames.size() + 1)), tables, comm);
  const auto put = [&](io::Series& series, const io::Piece& piece) {
    if (deck_.steps.empty())
      io::write_vtk(directory, series.name, piece, comm);
    else
      io::write_vtk(directory, series, state.rows->acts.time, piece, comm);
  };
  io::Piece contacts;
  if (!pairs.empty()) put(contact_, contacts = contact_piece(pairs, results.contact.surfaces));
  std::vector<Eigen::MatrixXd> holding, pressing;
  if (wanted(deck_, "contact_pressure"))
    pressing = contact_pressure(decomposition, interface, pairs, results.contact.surfaces, comm);
  if (wanted(deck_, "reaction_force")) holding = post::holding_forces(problem, decomposition, interface, state.solved.solution.x);
  const auto volume = volume_piece(deck_, decomposition, state.displacement, holding, pressing, results);
  put(volume_, volume.piece);
  const auto count = decomposition.catalogue.bodies.size() + pairs.size() + boundaries_in_use(deck_).size();
  const bool usual = count <= io::Options::usual_blocks && decomposition.catalogue.node_count <= io::Options::usual_nodes;
  if (deck_.output.blocks.value.value_or(usual))
    io::write_blocks(directory, blocks_, deck_.steps.empty() ? std::nullopt : std::optional(state.rows->acts.time),
                     named_blocks(deck_, decomposition, *state.rows, results, volume, contacts), comm);
  for (std::size_t k = 0; k < planes_.size(); ++k)
    put(planes_[k], plane_piece(deck_, decomposition, probes.planes[k], results.interior.planes[k]));
}

}  // namespace mortise
