#include "post/deformation.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>

#include "fem/element.hpp"
#include "mesh/shape_functions.hpp"
#include "wording.hpp"

namespace mortise::post {

namespace {

constexpr double large = 0.05;       // of a body's size
constexpr int most_places = 64;      // nodes and integration points of a cell
constexpr double of_largest = 1e-6;  // of the largest det of a cell: rounding of none, as where a brick is collapsed

// Gradients of the shape functions at the nodes and at the integration points.
const std::vector<Eigen::MatrixXd>& gradients(mesh::CellType type)
{
  static std::map<mesh::CellType, std::vector<Eigen::MatrixXd>> tables;
  auto& table = tables[type];
  if (!table.empty()) return table;
  const auto& functions = mesh::shape_functions(type);
  auto places = functions.nodes();
  for (const auto& place : fem::element(type).point) places.push_back(place);
  Eigen::VectorXd value(functions.count());
  for (const auto& place : places) {
    Eigen::MatrixXd gradient(functions.count(), mesh::dimension(type));
    functions.evaluate(place, value, &gradient);
    table.push_back(std::move(gradient));
  }
  return table;
}

// det of dx / dxi at a place, x: d x n.
template <int d>
double jacobian(const Eigen::MatrixXd& x, const Eigen::MatrixXd& gradient)
{
  const double *at = x.data(), *g = gradient.data();
  const Eigen::Index n = gradient.rows();
  Eigen::Matrix<double, d, d> result = Eigen::Matrix<double, d, d>::Zero();
  for (Eigen::Index i = 0; i < n; ++i)
    for (int b = 0; b < d; ++b)
      for (int a = 0; a < d; ++a) result(a, b) += at[i * d + a] * g[b * n + i];
  return result.determinant();
}

// Det of dx / dxi at each place of a table.
template <int d>
std::span<double> jacobians(const Eigen::MatrixXd& x, const std::vector<Eigen::MatrixXd>& tables,
                            std::array<double, most_places>& values)
{
  for (std::size_t i = 0; i < tables.size(); ++i) values[i] = jacobian<d>(x, tables[i]);
  return std::span(values).first(tables.size());
}

// The nodes of a cell, as columns.
void place_nodes(const mesh::Mesh& mesh, std::size_t cell, int dimension, Eigen::MatrixXd& x)
{
  const auto nodes = mesh.cells[cell];
  x.resize(dimension, static_cast<Eigen::Index>(nodes.size()));
  for (std::size_t i = 0; i < nodes.size(); ++i)
    x.col(static_cast<Eigen::Index>(i)) = mesh.points[static_cast<std::size_t>(nodes[i])].head(dimension);
}

Point centre(const Eigen::MatrixXd& x)
{
  Point result = Point::Zero();
  result.head(x.rows()) = x.rowwise().mean();
  return result;
}

// The smallest det of the deformed cell over that of the undeformed one, where that is not collapsed.
template <int d>
double least_volume_ratio(const Eigen::MatrixXd& x, const Eigen::MatrixXd& deformed, const std::vector<Eigen::MatrixXd>& tables)
{
  std::array<double, most_places> values, others;  // on the stack: this is asked for each cell
  const auto before = jacobians<d>(x, tables, values), after = jacobians<d>(deformed, tables, others);
  const double collapsed = of_largest * std::max(*std::ranges::max_element(before), 0.0);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < tables.size(); ++i)
    if (before[i] > collapsed) least = std::min(least, after[i] / before[i]);
  return least;
}

}  // namespace

std::vector<Warning> large_displacements(const partition::Decomposition& decomposition, const std::vector<double>& sizes,
                                         const std::vector<Eigen::VectorXd>& displacement, const Communicator& comm)
{
  const int dimension = decomposition.catalogue.dimension;
  std::vector<Found> found(sizes.size());
  for (std::size_t s = 0; s < displacement.size(); ++s)
    for (std::size_t n = 0; n < decomposition.subdomains[s].mesh.node_count(); ++n)
      found[static_cast<std::size_t>(decomposition.subdomains[s].body)].take(
          displacement[s].segment(static_cast<Eigen::Index>(n) * dimension, dimension).norm(),
          decomposition.subdomains[s].mesh.points[n]);
  found = largest_of_ranks(found, comm);
  std::vector<Warning> result;
  for (std::size_t b = 0; b < sizes.size(); ++b) {
    if (!(found[b].value > large * sizes[b])) continue;
    const auto& name = decomposition.catalogue.bodies[b].name;
    Warning w{"large_displacement",
              fmt::format("body \"{}\" moves by {:.3g} at {}, {:.3g} % of its size {:.3g}: beyond small displacements, for which "
                          "forces and contact are those of the undeformed bodies",
                          name, found[b].value, spell(found[b].at), 100 * found[b].value / sizes[b], sizes[b]),
              "hold the body, lower the loads, or draw the bodies where they come to rest"};
    w.at = found[b].at;
    w.body = name;
    w.value = found[b].value / sizes[b];
    w.limit = large;
    result.push_back(std::move(w));
  }
  return worst(std::move(result), "bodies");
}

std::vector<Warning> inverted_cells(const partition::Decomposition& decomposition,
                                    const std::vector<Eigen::VectorXd>& displacement, const Communicator& comm)
{
  const int dimension = decomposition.catalogue.dimension;
  std::vector<Found> found(decomposition.catalogue.bodies.size());  // minus the least ratio
  long long count = 0;
  for (std::size_t s = 0; s < displacement.size(); ++s) {
    if (decomposition.subdomains[s].skin) continue;  // panels enclose no volume of their own
    const auto& mesh = decomposition.subdomains[s].mesh;
    Eigen::MatrixXd x, deformed;
    for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
      const auto nodes = mesh.cells[c];
      place_nodes(mesh, c, dimension, x);
      deformed = x;
      for (std::size_t i = 0; i < nodes.size(); ++i)
        deformed.col(static_cast<Eigen::Index>(i)) += displacement[s].segment(nodes[i] * dimension, dimension);
      const auto& tables = gradients(mesh.cells.type[c]);
      const double ratio =
          dimension == 2 ? least_volume_ratio<2>(x, deformed, tables) : least_volume_ratio<3>(x, deformed, tables);
      if (ratio > 0) continue;
      ++count;
      found[static_cast<std::size_t>(decomposition.subdomains[s].body)].take(-ratio, centre(x));
    }
  }
  count = comm.sum(count);
  found = largest_of_ranks(found, comm);
  std::vector<Warning> result;
  for (std::size_t b = 0; b < found.size(); ++b) {
    if (!std::isfinite(found[b].value)) continue;
    const auto& name = decomposition.catalogue.bodies[b].name;
    Warning w{
        "inverted_cells",
        fmt::format("the result turns {} cells inside out, worst in body \"{}\" at {}: strains of this size mean nothing in "
                    "linear elasticity",
                    count, name, spell(found[b].at)),
        "lower the load or the interference, look at the units, or make the cells there larger or better shaped"};
    w.at = found[b].at;
    w.body = name;
    w.value = static_cast<double>(count);
    result.push_back(std::move(w));
  }
  // The worst by volume, not by the number of cells, which all of them name.
  if (result.size() > 1) {
    const auto worst_body =
        std::max_element(found.begin(), found.end(), [](const Found& a, const Found& b) { return a.value < b.value; });
    const auto& name = decomposition.catalogue.bodies[static_cast<std::size_t>(worst_body - found.begin())].name;
    std::erase_if(result, [&](const Warning& w) { return w.body != name; });
  }
  return result;
}

std::vector<Warning> folded_cells(const partition::Decomposition& decomposition, const Communicator& comm)
{
  const int dimension = decomposition.catalogue.dimension;
  Found found{0};  // minus the least part of the largest det of a cell
  long long count = 0;
  Eigen::MatrixXd x;
  std::array<double, most_places> values;
  for (const auto& subdomain : decomposition.subdomains) {
    if (subdomain.skin) continue;
    for (std::size_t c = 0; c < subdomain.mesh.cells.size(); ++c) {
      place_nodes(subdomain.mesh, c, dimension, x);
      const auto& tables = gradients(subdomain.mesh.cells.type[c]);
      const auto volumes = dimension == 2 ? jacobians<2>(x, tables, values) : jacobians<3>(x, tables, values);
      const auto [least, most] = std::ranges::minmax(volumes);
      if (least >= -of_largest * most) continue;
      ++count;
      found.take(-least / most, centre(x), subdomain.body);
    }
  }
  count = comm.sum(count);
  found = largest_of_ranks({found}, comm).front();
  if (count == 0) return {};
  const auto& name = decomposition.catalogue.bodies[static_cast<std::size_t>(found.body)].name;
  Warning w{"folded_cells",
            fmt::format("{} cells are folded, worst in body \"{}\" at {}: near some of their nodes they are inside out, and "
                        "stresses there mean nothing",
                        count, name, spell(found.at)),
            "move nodes between corners to the middle of their edges, or mesh anew"};
  w.at = found.at;
  w.body = name;
  w.value = static_cast<double>(count);
  return {w};
}

}  // namespace mortise::post
