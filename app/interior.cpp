#include "interior.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <span>

#include "fem/quantity.hpp"
#include "local_fields.hpp"

namespace mortise {

namespace {

using Tables = std::vector<io::Table>;

Tables tables_of_values(const std::string& name, const std::string& what, Global total)
{
  return {{name + "/points", "coordinates of " + what, 3, total, {}, {}},
          {name + "/displacement", "displacement", 3, total, {}, {}},
          {name + "/von_mises", "von Mises stress", 1, total, {}, {}},
          {name + "/stress", "XX YY ZZ XY YZ XZ", 6, total, {}, {}}};
}

void add_row(Global row, const Point& at, const post::Values& values, Eigen::Index i, Tables& tables)
{
  const auto put = [](const auto& from, std::vector<double>& to) { to.insert(to.end(), from.begin(), from.end()); };
  for (std::size_t t = 0; t < 4; ++t) tables[t].row.push_back(row);
  put(at, tables[0].values);
  put(values.displacement.row(i), tables[1].values);
  tables[2].values.push_back(fem::von_mises(values.stress.row(i).transpose()));
  put(values.stress.row(i), tables[3].values);
}

// Of the nodes inside boundary elements.
Tables node_tables_inside(const partition::Decomposition& decomposition, const post::Results& results, const Communicator& comm)
{
  Global mine = 0;
  for (const auto& values : results.interior.nodes) mine += values.stress.rows();
  auto tables = tables_of_values("interior", "the nodes inside bodies of boundary elements", comm.sum(mine));
  for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
    const auto& subdomain = decomposition.subdomains[s];
    const auto& values = results.interior.nodes[s];
    for (Eigen::Index i = 0; i < values.stress.rows(); ++i) {
      const std::size_t n = subdomain.mesh.node_count() + static_cast<std::size_t>(i);
      add_row(subdomain.inside.node_id[n] - decomposition.catalogue.node_count, subdomain.inside.points[n], values, i, tables);
    }
  }
  return tables;
}

Tables point_tables(const post::Probes& probes, const post::Results& results)
{
  auto tables = tables_of_values("points", "the points of output.interior, of each in each body that it lies in", probes.rows);
  auto& body = tables.emplace_back(io::Table{"points/body", "place of the body among all, from 0", 1, probes.rows, {}, {}});
  for (const auto& p : probes.points) {
    body.row.push_back(p.row);
    body.values.push_back(p.body);
  }
  for (std::size_t i = 0; i < probes.points.size(); ++i)
    add_row(probes.points[i].row, probes.points[i].place.at, results.interior.points, static_cast<Eigen::Index>(i), tables);
  return tables;
}

}  // namespace

std::string quoted(const std::string& name)
{
  if (name.find_first_of(",\"\n") == std::string::npos) return name;
  std::string result = "\"";
  for (const char c : name) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + "\"";
}

bool wanted(const model::Deck& deck, const std::string& field)
{
  const auto& fields = deck.output.fields;
  return std::find(fields.begin(), fields.end(), field) != fields.end();
}

std::vector<io::Table> interior_tables(const partition::Decomposition& decomposition, const post::Probes& probes,
                                       const post::Results& results, const Communicator& comm)
{
  Tables tables;
  const auto append = [&](Tables more) { std::move(more.begin(), more.end(), std::back_inserter(tables)); };
  if (probes.cells) append(node_tables_inside(decomposition, results, comm));
  if (probes.rows > 0) append(point_tables(probes, results));
  return tables;
}

io::Piece plane_piece(const model::Deck& deck, const partition::Decomposition& decomposition, const post::PlaneSection& section,
                      const post::Values& values)
{
  io::Piece piece;
  io::Field displacement{"displacement", 3, {}}, von_mises{"von_mises", 1, {}}, stress{"stress", 6, {}},
      principal{"principal_stress", 3, {}};
  const bool with_principal = wanted(deck, principal.name);
  io::Field body{"body", 1, {}, true}, owner{"subdomain", 1, {}, true};
  LocalFields local(deck, section.places.size());
  for (std::size_t p = 0; p < section.places.size(); ++p) {
    const auto row = static_cast<Eigen::Index>(p);
    piece.points.push_back(section.places[p].at);
    for (const double x : values.displacement.row(row)) displacement.values.push_back(x);
    von_mises.values.push_back(fem::von_mises(values.stress.row(row).transpose()));
    for (const double x : values.stress.row(row)) stress.values.push_back(x);
    local.set(p, section.places[p].at, values.displacement.row(row).transpose(), values.stress.row(row).transpose());
    if (!with_principal) continue;
    for (const double x : fem::principal_stresses(values.stress.row(row).transpose())) principal.values.push_back(x);
  }
  for (const auto& triangle : section.triangles) {
    piece.cells.add(mesh::CellType::tri3, triangle);
    const auto& subdomain = decomposition.subdomains[section.places[static_cast<std::size_t>(triangle[0])].subdomain];
    body.values.push_back(subdomain.body);
    owner.values.push_back(static_cast<double>(subdomain.id));
  }
  for (auto* field : {&displacement, &von_mises, &stress, &principal})
    if (wanted(deck, field->name)) piece.point_fields.push_back(std::move(*field));
  local.move_to(piece);
  piece.cell_fields = {std::move(body), std::move(owner)};
  return piece;
}

std::string point_header(const model::Deck& deck)
{
  return (deck.steps.empty() ? "" : "step,time,") + std::string("x,y,z,body,ux,uy,uz,sxx,syy,szz,sxy,syz,sxz,von_mises\n");
}

std::string point_rows(const model::Deck& deck, const mesh::Catalogue& catalogue, const model::LoadState& acts,
                       const post::Probes& probes, const post::Values& values, const Communicator& comm)
{
  struct Row {
    Global number;
    int body;
    std::array<double, 13> values;  // x y z, displacement, stress, von Mises
  };
  std::vector<Row> mine;
  for (std::size_t i = 0; i < probes.points.size(); ++i) {
    const auto& probe = probes.points[i];
    const auto index = static_cast<Eigen::Index>(i);
    Row& row = mine.emplace_back(Row{probe.row, probe.body, {}});
    Eigen::Map<Eigen::Matrix<double, 13, 1>> all(row.values.data());
    all << probe.place.at, values.displacement.row(index).transpose(), values.stress.row(index).transpose(),
        fem::von_mises(values.stress.row(index).transpose());
  }
  auto rows = comm.all_gather(mine);
  std::sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.number < b.number; });
  std::string text;
  for (const auto& row : rows) {
    if (!deck.steps.empty()) text += fmt::format("{},{},", quoted(acts.step), acts.time);
    const std::span numbers(row.values);
    text += fmt::format("{},{},{}\n", fmt::join(numbers.first(3), ","),
                        quoted(catalogue.bodies[static_cast<std::size_t>(row.body)].name), fmt::join(numbers.subspan(3), ","));
  }
  return text;
}

}  // namespace mortise
