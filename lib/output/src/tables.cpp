#include "output/tables.hpp"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <utility>

#include "base/places.hpp"
#include "fem/quantity.hpp"

namespace mortise::output {

namespace {

using Tables = std::vector<io::Table>;

constexpr const char* components = "XX YY ZZ XY YZ XZ";

template <class Values>
void append(const Values& values, io::Table& table)
{
  table.values.insert(table.values.end(), values.begin(), values.end());
}

// Of points: where they are, how they move, and their stress.
Tables tables_of_points(const std::string& group, const std::string& places, const std::string& how, Global total)
{
  return {{group + "/points", places, 3, total, {}, {}},
          {group + "/displacement", "displacement", 3, total, {}, {}},
          {group + "/von_mises", "von Mises stress" + how, 1, total, {}, {}},
          {group + "/stress", components + how, 6, total, {}, {}}};
}

void add_row(Global row, const Point& at, const post::Values& values, Eigen::Index i, Tables& tables)
{
  for (std::size_t t = 0; t < 4; ++t) tables[t].row.push_back(row);
  append(at, tables[0]);
  append(values.displacement.row(i), tables[1]);
  tables[2].values.push_back(fem::von_mises(values.stress.row(i).transpose()));
  append(values.stress.row(i), tables[3]);
}

// Of the nodes inside boundary elements.
Tables node_tables_inside(const partition::Decomposition& decomposition, const post::Interior& interior, const Communicator& comm)
{
  Global mine = 0;
  for (const auto& values : interior.nodes) mine += values.stress.rows();
  auto tables = tables_of_points("interior", "coordinates of the nodes inside bodies of boundary elements", "", comm.sum(mine));
  for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
    const auto& subdomain = decomposition.subdomains[s];
    const auto& values = interior.nodes[s];
    for (Eigen::Index i = 0; i < values.stress.rows(); ++i) {
      const std::size_t n = subdomain.mesh.node_count() + static_cast<std::size_t>(i);
      add_row(subdomain.inside.node_id[n] - decomposition.catalogue.node_count, subdomain.inside.points[n], values, i, tables);
    }
  }
  return tables;
}

Tables point_tables(const post::Probes& probes, const post::Values& values)
{
  auto tables = tables_of_points("points", "coordinates of the points of output.interior, of each in each body that it lies in",
                                 "", probes.rows);
  auto& body = tables.emplace_back(io::Table{"points/body", "place of the body among all, from 0", 1, probes.rows, {}, {}});
  for (const auto& p : probes.points) {
    body.row.push_back(p.row);
    body.values.push_back(p.body);
  }
  for (std::size_t i = 0; i < probes.points.size(); ++i)
    add_row(probes.points[i].row, probes.points[i].place.at, values, static_cast<Eigen::Index>(i), tables);
  return tables;
}

}  // namespace

std::vector<io::Table> node_tables(const partition::Decomposition& decomposition, const partition::Interface& interface,
                                   const std::vector<Eigen::VectorXd>& displacement, const post::StressField& stress)
{
  const Global total = decomposition.catalogue.node_count;
  const int dimension = decomposition.catalogue.dimension;
  auto tables = tables_of_points("nodes", "coordinates", ", recovered inside the body", total);
  for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
    const auto& subdomain = decomposition.subdomains[s];
    std::size_t shared = 0;
    for (std::size_t n = 0; n < subdomain.mesh.node_count(); ++n) {
      if (shared < interface.nodes[s].size() && interface.nodes[s][shared] == static_cast<Local>(n)) {
        if (interface.copies[s][shared++][0].subdomain != subdomain.id) continue;
      }
      for (auto& table : tables) table.row.push_back(subdomain.mesh.node_id[n]);
      append(subdomain.mesh.points[n], tables[0]);
      Point u = Point::Zero();
      u.head(dimension) = displacement[s].segment(static_cast<Eigen::Index>(n) * dimension, dimension);
      append(u, tables[1]);
      tables[2].values.push_back(stress.nodal_von_mises[s][static_cast<Eigen::Index>(n)]);
      append(stress.nodal[s].row(static_cast<Eigen::Index>(n)), tables[3]);
    }
  }
  return tables;
}

std::vector<io::Table> cell_tables(const partition::Decomposition& decomposition, const post::StressField& stress,
                                   const Communicator& comm)
{
  std::vector<const mesh::Mesh*> meshes;
  const Global total = decomposition.catalogue.cell_count;
  io::Table body{"cells/body", "number of the cell's body, from 0, as in body_names of summary.json", 1, total, {}, {}},
      von_mises{"cells/von_mises", "von Mises stress, mean of the cell", 1, total, {}, {}};
  for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
    const auto& subdomain = decomposition.subdomains[s];
    const auto& mesh = subdomain.mesh;
    const auto& of_cells = stress.cell_von_mises[s];
    meshes.push_back(&mesh);
    body.values.insert(body.values.end(), mesh.cells.size(), static_cast<double>(subdomain.body));
    von_mises.values.insert(von_mises.values.end(), of_cells.begin(), of_cells.end());
    for (auto* table : {&body, &von_mises}) table->row.insert(table->row.end(), mesh.cell_id.begin(), mesh.cell_id.end());
  }
  auto tables = io::cell_tables(meshes, total, comm);
  tables.push_back(std::move(body));
  tables.push_back(std::move(von_mises));
  return tables;
}

io::Table contact_table(const std::vector<contact::ContactNodeState>& nodes, const Communicator& comm)
{
  // At a kink two points share a node.
  std::vector<std::array<double, 4>> keys;
  for (const auto& p : nodes) keys.push_back({static_cast<double>(p.contact), static_cast<double>(p.node), p.area, p.gap});
  io::Table table{
      "contact/points",
      "contact, node, area, normal force, force on the secondary side (3), gap, slip (3), status 0 open 1 stick 2 slip",
      12,
      static_cast<Global>(comm.sum(static_cast<long long>(nodes.size()))),
      places_among_all(keys, comm),
      {}};
  for (const auto& p : nodes) {
    append(std::initializer_list<double>{static_cast<double>(p.contact), static_cast<double>(p.node), p.area, p.force}, table);
    append(p.force_on_secondary, table);
    table.values.push_back(p.gap);
    append(p.slip, table);
    table.values.push_back(static_cast<double>(static_cast<int>(p.status)));
  }
  return table;
}

io::Table multiplier_table(const feti::DualProblem& problem, const Vector& lambda)
{
  io::Table table{"dual/multipliers",
                  "forces of the rows: gluing (between copies of a node), supports, contacts, gauges",
                  1,
                  problem.system().dual_unknowns(),
                  {},
                  {}};
  const Eigen::VectorXd values = problem.forces(lambda);
  const auto rows = problem.jump().rows()->getNodeElementList();
  table.row.assign(rows.begin(), rows.end());
  table.values.assign(values.begin(), values.end());
  return table;
}

std::vector<io::Table> interior_tables(const partition::Decomposition& decomposition, const post::Probes& probes,
                                       const post::Interior& interior, const Communicator& comm)
{
  Tables tables;
  if (probes.cells) tables = node_tables_inside(decomposition, interior, comm);
  if (probes.rows > 0)
    for (auto& table : point_tables(probes, interior.points)) tables.push_back(std::move(table));
  return tables;
}

}  // namespace mortise::output
