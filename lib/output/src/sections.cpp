#include "output/sections.hpp"

#include <algorithm>
#include <array>
#include <span>

#include "csv.hpp"
#include "fem/quantity.hpp"
#include "point_fields.hpp"

namespace mortise::output {

io::Piece plane_piece(const model::Deck& deck, const partition::Decomposition& decomposition, const post::PlaneSection& section,
                      const post::Values& values)
{
  io::Piece piece;
  PointFields fields(deck, section.places.size());
  for (std::size_t p = 0; p < section.places.size(); ++p) {
    const auto row = static_cast<Eigen::Index>(p);
    piece.points.push_back(section.places[p].at);
    fields.set(p, section.places[p].at, values.displacement.row(row).transpose(), values.stress.row(row).transpose());
  }
  fields.move_to(piece);
  io::Field body{"body", 1, {}, true}, owner{"subdomain", 1, {}, true};
  for (const auto& triangle : section.triangles) {
    piece.cells.add(mesh::CellType::tri3, triangle);
    const auto& subdomain = decomposition.subdomains[section.places[static_cast<std::size_t>(triangle[0])].subdomain];
    body.values.push_back(subdomain.body);
    owner.values.push_back(static_cast<double>(subdomain.id));
  }
  piece.cell_fields = {std::move(body), std::move(owner)};
  return piece;
}

std::string point_header(const model::Deck& deck)
{
  return header_of_states(deck) + "x,y,z,body,ux,uy,uz,sxx,syy,szz,sxy,syz,sxz,von_mises\n";
}

std::string point_rows(const mesh::Catalogue& catalogue, const model::LoadState& acts, const post::Probes& probes,
                       const post::Values& values, const Communicator& comm)
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
    const std::span numbers(row.values);
    text += entries_of_state(acts) + fmt::format("{},{},{}\n", fmt::join(numbers.first(3), ","),
                                                 quoted(catalogue.bodies[static_cast<std::size_t>(row.body)].name),
                                                 fmt::join(numbers.subspan(3), ","));
  }
  return text;
}

}  // namespace mortise::output
