#include "post/deformation.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "fem/element.hpp"
#include "mesh/shape_functions.hpp"
#include "wording.hpp"

namespace mortise::post {

namespace {

constexpr double large = 0.05;   // of a body's size
constexpr int most_places = 64;  // nodes and integration points of a cell

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

// The smallest det of the deformed cell over that of the undeformed one, where that is not collapsed.
template <int d>
double least_volume_ratio(const Eigen::MatrixXd& x, const Eigen::MatrixXd& deformed, const std::vector<Eigen::MatrixXd>& tables)
{
  std::array<double, most_places> before, after;  // on the stack: this is asked for each cell
  for (std::size_t i = 0; i < tables.size(); ++i) {
    before[i] = jacobian<d>(x, tables[i]);
    after[i] = jacobian<d>(deformed, tables[i]);
  }
  const double collapsed = 1e-6 * std::max(*std::max_element(before.begin(), before.begin() + tables.size()), 0.0);
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
      x.resize(dimension, static_cast<Eigen::Index>(nodes.size()));
      deformed.resize(dimension, x.cols());
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        const auto at = static_cast<Eigen::Index>(i);
        x.col(at) = mesh.points[static_cast<std::size_t>(nodes[i])].head(dimension);
        deformed.col(at) = x.col(at) + displacement[s].segment(nodes[i] * dimension, dimension);
      }
      const auto& tables = gradients(mesh.cells.type[c]);
      const double ratio =
          dimension == 2 ? least_volume_ratio<2>(x, deformed, tables) : least_volume_ratio<3>(x, deformed, tables);
      if (ratio > 0) continue;
      ++count;
      Point centre = Point::Zero();
      centre.head(dimension) = x.rowwise().mean();
      found[static_cast<std::size_t>(decomposition.subdomains[s].body)].take(-ratio, centre);
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

}  // namespace mortise::post
