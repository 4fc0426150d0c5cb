#include "post/deformation.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <unordered_map>

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

// What a row needs to know of a node: its displacement, and the size of the faces of secondary sides at it.
struct Nodal {
  Global node;
  double u[3], size;
};

double size_of(const mesh::Surface& surface, std::size_t face)
{
  const auto nodes = surface.faces[face];
  const int corners = mesh::corner_count(surface.faces.type[face]);
  double result = 0;
  for (int i = 0; i < corners; ++i)
    for (int j = 0; j < i; ++j)
      result = std::max(result, (surface.points[static_cast<std::size_t>(nodes[static_cast<std::size_t>(i)])] -
                                 surface.points[static_cast<std::size_t>(nodes[static_cast<std::size_t>(j)])])
                                    .norm());
  return result;
}

// This rank's nodes of all sides.
std::vector<Nodal> own_nodes(std::span<const contact::Pair> pairs, const partition::Decomposition& decomposition,
                             const std::vector<Eigen::VectorXd>& displacement)
{
  std::unordered_map<Global, double> sizes;
  for (const auto& pair : pairs) {
    if (pair.primary)
      for (const Global node : pair.primary->node_id) sizes.emplace(node, 0.0);
    for (std::size_t f = 0; f < pair.secondary.faces.size(); ++f) {
      const double size = size_of(pair.secondary, f);
      for (const Local n : pair.secondary.faces[f]) {
        auto& known = sizes[pair.secondary.node_id[static_cast<std::size_t>(n)]];
        known = std::max(known, size);
      }
    }
  }
  const int dimension = decomposition.catalogue.dimension;
  std::vector<Nodal> result;
  for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
    const auto& ids = decomposition.subdomains[s].mesh.node_id;
    for (std::size_t n = 0; n < ids.size(); ++n) {
      const auto found = sizes.find(ids[n]);
      if (found == sizes.end()) continue;
      Nodal nodal{ids[n], {0, 0, 0}, found->second};
      for (int c = 0; c < dimension; ++c) nodal.u[c] = displacement[s][static_cast<Eigen::Index>(n) * dimension + c];
      result.push_back(nodal);
    }
  }
  return result;
}

// Of the nodes asked for what all ranks know; nodes meet on rank node % ranks. Collective.
std::unordered_map<Global, Nodal> fetch(std::vector<Global> nodes, const std::vector<Nodal>& own, const Communicator& comm)
{
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  const auto ranks = static_cast<std::size_t>(comm.size());
  std::vector<std::vector<Nodal>> told(ranks);
  std::vector<std::vector<Global>> wanted(ranks);
  for (const auto& nodal : own) told[static_cast<std::size_t>(nodal.node) % ranks].push_back(nodal);
  for (const Global node : nodes) wanted[static_cast<std::size_t>(node) % ranks].push_back(node);
  std::unordered_map<Global, Nodal> known;
  for (const auto& part : comm.exchange(told))
    for (const auto& nodal : part) {
      const auto [place, fresh] = known.emplace(nodal.node, nodal);
      if (!fresh) place->second.size = std::max(place->second.size, nodal.size);
    }
  std::vector<std::vector<Nodal>> answers(ranks);
  const auto asked = comm.exchange(wanted);
  for (std::size_t r = 0; r < ranks; ++r)
    for (const Global node : asked[r])
      if (const auto found = known.find(node); found != known.end()) answers[r].push_back(found->second);
  std::unordered_map<Global, Nodal> result;
  for (const auto& part : comm.exchange(answers))
    for (const auto& nodal : part) result.emplace(nodal.node, nodal);
  return result;
}

// The jump of the displacements at a point, along the surface. A normal row has m n at each node; of nodes that supports hold in
// part it has the other components.
Point tangential_jump(const constraint::Contacts& contacts, const constraint::ContactNode& point,
                      const std::unordered_map<Global, Nodal>& nodes)
{
  std::map<Global, std::array<double, 2>> parts;  // of each node: |n_c| of the best component, m from it
  for (const auto& entry : contacts.rows[point.row]) {
    const double n = point.normal[entry.component];
    auto& [best, m] = parts[entry.node];
    if (std::abs(n) > best) best = std::abs(n), m = entry.coefficient / n;
  }
  Point jump = Point::Zero();
  for (const auto& [node, part] : parts)
    if (const auto found = nodes.find(node); found != nodes.end()) jump += part[1] * Eigen::Map<const Point>(found->second.u);
  jump /= point.weight;
  return jump - jump.dot(point.normal) * point.normal;
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

std::vector<Warning> long_slides(std::span<const contact::Pair> pairs, const constraint::Contacts& contacts,
                                 std::span<const contact::ContactNodeState> points, const partition::Decomposition& decomposition,
                                 const std::vector<Eigen::VectorXd>& displacement, const Communicator& comm)
{
  const auto counts = [&](std::size_t i) {
    const auto& options = pairs[static_cast<std::size_t>(points[i].contact)].options;
    return points[i].status != contact::Status::open && options.law != contact::Law::bonded && !options.cyclic;
  };
  std::vector<Global> wanted;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (counts(i)) {
      wanted.push_back(contacts.nodes[i].node);
      for (const auto& entry : contacts.rows[contacts.nodes[i].row]) wanted.push_back(entry.node);
    }
  const auto nodes = fetch(std::move(wanted), own_nodes(pairs, decomposition, displacement), comm);
  std::vector<Found> longest(pairs.size()), parts(pairs.size());  // slide; slide over size of the face
  std::vector<double> closed(pairs.size(), 0.0);                  // nodes
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!counts(i)) continue;
    const auto& point = contacts.nodes[i];
    closed[static_cast<std::size_t>(point.contact)] += 1;
    const auto found = nodes.find(point.node);
    if (found == nodes.end() || !(found->second.size > 0)) continue;
    const double slide = tangential_jump(contacts, point, nodes).norm();
    const auto c = static_cast<std::size_t>(point.contact);
    parts[c].take(slide / found->second.size, point.at);
    longest[c].take(slide, point.at);
  }
  parts = largest_of_ranks(parts, comm);
  longest = largest_of_ranks(longest, comm);
  comm.sum_in_place(closed);
  // Of the corners of one facet: what is round turns until it stands on it.
  constexpr double part_on_a_facet = 0.1;
  const double corners = decomposition.catalogue.dimension;
  std::vector<Warning> result;
  for (std::size_t c = 0; c < pairs.size(); ++c) {
    const bool on_a_facet = closed[c] <= corners;
    const double limit = on_a_facet ? part_on_a_facet : 1;
    if (!(parts[c].value > limit)) continue;
    Warning w{
        "long_slide",
        fmt::format("in contact {} a point at {} slides over {:.3g} of its face, by up to {:.3g}: it presses where it stood "
                    "before, not where it came to{}",
                    pairs[c].options.name, spell(parts[c].at), parts[c].value, longest[c].value,
                    on_a_facet ? "; so few nodes press that, if the body is round, it turns until it stands on a facet" : ""),
        "draw the bodies where they come to rest, hold what slides, or take larger faces if the surfaces are flat"};
    w.at = parts[c].at;
    w.contact = pairs[c].options.name;
    w.boundary = pairs[c].options.secondary;
    w.value = parts[c].value;
    w.limit = limit;
    result.push_back(std::move(w));
  }
  return worst(std::move(result), "contacts");
}

}  // namespace mortise::post
