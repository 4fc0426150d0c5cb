// A block on a larger one, each cut in two, with linear displacements and stresses that nobody solved for. The same on any ranks.
#pragma once

#include <optional>

#include "contact/state.hpp"
#include "io/vtk.hpp"
#include "model/deck.hpp"
#include "post/results.hpp"
#include "testing/cut.hpp"

namespace mortise::output {

const std::string deck_of_blocks = R"(
mesh:
  blocks:
    lower: {size: [2, 1, 1], cells: [4, 2, 2]}
    upper: {origin: [0.5, 0, 1], size: [1, 1, 1], cells: [3, 2, 2]}
materials: {steel: {young_modulus: 1000, poisson_ratio: 0}}
bodies: {"*": {material: steel}}
decomposition: {method: grid, counts: {lower: [2, 1, 1], upper: [1, 1, 2]}}
)";

struct DeckOfBlocks {
  Communicator comm;
  deck::Document document;
  model::Deck deck;
  partition::Decomposition decomposition;
  std::optional<partition::NodeDirectory> directory;
  partition::Interface interface;
  std::vector<Eigen::VectorXd> displacement;
  post::Fields fields;

  // With these further sections.
  explicit DeckOfBlocks(const std::string& sections)
      : document(deck_of_blocks + sections, "deck.yaml", {}), deck(model::read_deck(document, ""))
  {
    document.check();
    decomposition = partition::cut_of(deck.mesh, deck.decomposition, comm);
    for (const auto& subdomain : decomposition.subdomains) add_fields(subdomain.mesh);
    directory.emplace(partition::even_directory(decomposition, comm));
    interface = partition::find_interface(decomposition, *directory, comm);
  }

  static Point moved(const Point& x) { return {1 + x[0], 2 - 3 * x[1] + x[2], x[0] * 5}; }
  static fem::Stress stress(const Point& x)
  {
    return (fem::Stress() << 10 + x[0], -20 + 2 * x[1], 5 * x[2], 3, x[0] + x[1], -7).finished();
  }

  mesh::Surface side(const std::string& name) const { return partition::side_of(decomposition, name); }
  contact::Pair joint() const
  {
    contact::Options options;
    options.name = "joint";
    options.secondary = "upper.zmin";
    return {options, side("upper.zmin"), std::make_shared<mesh::Surface>(side("lower.zmax"))};
  }
  // Nothing at all.
  static contact::SurfaceState no_state(const mesh::Surface& side)
  {
    const auto n = side.points.size();
    contact::SurfaceState state;
    state.pressure = state.gap = state.recovered_pressure = std::vector<double>(n, 0.0);
    state.traction = state.slip = std::vector<Point>(n, Point::Zero());
    state.status.resize(n, 0);
    state.near.resize(n, 1);
    return state;
  }

 private:
  void add_fields(const mesh::Mesh& mesh)
  {
    const auto n = static_cast<Eigen::Index>(mesh.node_count());
    auto& u = displacement.emplace_back(3 * n);
    auto& nodal = fields.stress.nodal.emplace_back(n, 6);
    auto& von_mises = fields.stress.nodal_von_mises.emplace_back(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto& x = mesh.points[static_cast<std::size_t>(i)];
      u.segment(3 * i, 3) = moved(x);
      nodal.row(i) = stress(x).transpose();
      von_mises[i] = fem::von_mises(stress(x));
    }
    auto& of_cells = fields.stress.cell_von_mises.emplace_back(static_cast<Eigen::Index>(mesh.cells.size()));
    for (std::size_t c = 0; c < mesh.cells.size(); ++c)
      of_cells[static_cast<Eigen::Index>(c)] = static_cast<double>(mesh.cell_id[c]);
  }
};

inline std::vector<std::string> names_of(const std::vector<io::Field>& fields)
{
  std::vector<std::string> names;
  for (const auto& field : fields) names.push_back(field.name);
  return names;
}

// The values of a field at a point or in a cell.
inline Eigen::VectorXd at(const std::vector<io::Field>& fields, const std::string& name, std::size_t number)
{
  for (const auto& field : fields)
    if (field.name == name)
      return Eigen::Map<const Eigen::VectorXd>(&field.values.at(number * static_cast<std::size_t>(field.components)),
                                               field.components);
  ADD_FAILURE() << "no field " << name;
  return {};
}

}  // namespace mortise::output
