#include "constraint/pretension.hpp"

#include <fmt/format.h>

#include "base/dense.hpp"
#include "base/error.hpp"

namespace mortise::constraint {

namespace {

// Length of the mean of unit normals below which a surface has no direction.
constexpr double least_mean = 0.5;

// The projector onto what supports of both sides hold at a node: what its secondary node does not feel in any row, without the
// rows' own directions, along which the primary side moves. A normal leans a little into what is held.
Eigen::Matrix3d supported_on_both_sides(const Contacts& contacts, const ContactNode& node, int dimension)
{
  constexpr double nothing = 1e-6, leans = 0.55;  // squares
  Eigen::Matrix3d felt = Eigen::Matrix3d::Zero(), axes = node.normal * node.normal.transpose();
  for (const Point& tangent : node.tangents) axes += tangent * tangent.transpose();
  for (std::size_t row = node.row; row <= node.row + node.tangents.size(); ++row) {
    Point own = Point::Zero();
    for (const auto& entry : contacts.rows[row])
      if (entry.node == node.node) own[entry.component] += entry.coefficient;
    felt += own * own.transpose();
  }
  Eigen::Matrix3d moves = Eigen::Matrix3d::Zero();  // the secondary node
  const auto found = dense::space_eigenpairs(felt);
  for (Eigen::Index k = 0; k < 3; ++k)
    if (found.values[k] > nothing) moves += found.vectors.col(k) * found.vectors.col(k).transpose();
  if (dimension == 2) moves(2, 2) = 1;
  const Eigen::Matrix3d rest = Eigen::Matrix3d::Identity() - moves;
  const auto along = dense::space_eigenpairs(moves + rest * axes * rest);
  Eigen::Matrix3d result = Eigen::Matrix3d::Zero();
  for (Eigen::Index k = 0; k < 3; ++k)
    if (along.values[k] < leans) result += along.vectors.col(k) * along.vectors.col(k).transpose();
  return result;
}

// The sum of these over the nodes of a section. Collective.
Eigen::Matrix3d supported_directions(const Contacts& contacts, const Preload& preload, int dimension, const Communicator& comm)
{
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const auto& node : contacts.nodes)
    if (node.contact == preload.contact) sum += supported_on_both_sides(contacts, node, dimension);
  std::vector<double> all(sum.data(), sum.data() + 9);
  comm.sum_in_place(all);
  return Eigen::Map<const Eigen::Matrix3d>(all.data());
}

// `vector` without its part in the range of `supported`.
Point without(const Point& vector, const Eigen::Matrix3d& supported)
{
  constexpr double rounding = 1e-3;  // of eigenvalues, as normals of facets of one plane differ
  const auto found = dense::space_eigenpairs(supported);
  Point rest = vector;
  for (Eigen::Index k = 0; k < 3; ++k)
    if (found.values[k] > rounding * supported.trace()) rest -= vector.dot(found.vectors.col(k)) * found.vectors.col(k);
  return rest;
}

Point direction(const Contacts& contacts, const Preload& preload, int dimension, const std::optional<Point>& axis,
                const Communicator& comm)
{
  std::vector<double> sums(4, 0.0);  // area times normal, area
  for (const auto& node : contacts.nodes) {
    if (node.contact != preload.contact) continue;
    for (int c = 0; c < 3; ++c)
      sums[static_cast<std::size_t>(c)] += node.area * (node.across.isZero(0) ? node.normal : node.across)[c];
    sums[3] += node.area;
  }
  comm.sum_in_place(sums);
  if (!(sums[3] > 0))
    throw Error(ExitStatus::bad_input, fmt::format("contact \"{}\": the two sides of its pretension section do not meet, so that "
                                                   "no bolt can be preloaded there; look at the names of the boundaries or set a "
                                                   "larger search_distance",
                                                   preload.name));
  Point mean = Point(sums[0], sums[1], sums[2]) / sums[3];
  mean = axis ? Point(mean.dot(*axis) * *axis) : without(mean, supported_directions(contacts, preload, dimension, comm));
  if (mean.norm() < least_mean)
    throw Error(ExitStatus::bad_input,
                fmt::format("contact \"{}\": the normals of its pretension section point all ways, or where "
                            "supports hold both sides, so that it cannot be drawn together; expected one "
                            "cut across the shank of a bolt{}",
                            preload.name, axis ? ", whose axis is that of revolution or of the sector" : ""));
  return mean.normalized();
}

}  // namespace

std::vector<PretensionSection> find_pretension_sections(const Contacts& contacts, std::span<const Preload> preloads,
                                                        int dimension, const AxisOf& axis, const Communicator& comm)
{
  std::vector<PretensionSection> pretension_sections;
  for (const auto& preload : preloads) {
    PretensionSection section{preload, direction(contacts, preload, dimension, axis ? axis(preload) : std::nullopt, comm), {}};
    for (const auto& node : contacts.nodes) {
      if (node.contact != preload.contact) continue;
      section.rows.push_back({node.row, node.weight * section.normal.dot(node.normal)});
      for (std::size_t t = 0; t < node.tangents.size(); ++t)
        section.rows.push_back({node.row + 1 + t, node.weight * section.normal.dot(node.tangents[t])});
    }
    pretension_sections.push_back(std::move(section));
  }
  return pretension_sections;
}

}  // namespace mortise::constraint
