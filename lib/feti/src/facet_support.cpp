#include "feti/facet_support.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

#include "body_rows.hpp"
#include "feti/coarse_problem.hpp"

namespace mortise::feti {

namespace {

// Of what rows feel differently from node to node, what facets may be the cause of: a part of the root of FreeMotion::sagitta,
// and rounding. More is a shape.
constexpr double of_facets = 0.15, rounding = 1e-6;

struct Search {
  const DualProblem& problem;
  const std::vector<mesh::Body>& catalogue;
  const Bodies& bodies;
  const BodyRows& rows;
  std::span<const constraint::SlidingSurface> sliding_surfaces;
  Eigen::VectorXd force;  // of each row of this rank
  std::span<const double> bounds;
  double slack;

  Local first() const { return problem.jump().ranges().dirichlet; }
};

// The rows without the tangential ones of the nodes that `slips` marks.
BodyRows without_friction(const Search& search, const std::vector<bool>& slips)
{
  BodyRows result = search.rows;
  Eigen::VectorXd kept = Eigen::VectorXd::Ones(result.values.rows());
  for (std::size_t i = 0; i < slips.size(); ++i) {
    if (!slips[i]) continue;
    const auto& rows = search.problem.node_rows()[i];
    kept.segment(rows.normal + 1 - search.first(), rows.tangents).setZero();
    result.fixed.segment(rows.normal + 1 - search.first(), rows.tangents).setZero();
  }
  result.values = SparseMatrix(kept.asDiagonal() * search.rows.values);
  return result;
}

// What friction holds at most along a motion, and what all normals of a contact feel of it alike.
struct Felt {
  double friction = 0, alike = 0;
  bool facets = false;  // the rest is no more than what facets may feel
};

Felt feel(const Search& search, const Eigen::VectorXd& amplitudes, double sagitta)
{
  const auto& problem = search.problem;
  const auto& contacts = problem.constraints().contacts;
  const Eigen::VectorXd felt = search.rows.values * amplitudes;
  double last = -1;
  for (const auto& node : contacts.nodes) last = std::max(last, static_cast<double>(node.contact));
  const auto count = static_cast<std::size_t>(problem.communicator().max(last) + 1);
  constexpr std::size_t sums_each = 5;  // friction; area, area * n.v, area * (n.v)^2, normal force
  std::vector<double> sums(count * sums_each, 0.0);
  for (std::size_t i = 0; i < contacts.nodes.size(); ++i) {
    if (contacts.bonded[i]) continue;
    const auto& rows = problem.node_rows()[i];
    double* sum = &sums[static_cast<std::size_t>(contacts.nodes[i].contact) * sums_each];
    const double normal = felt[rows.normal - search.first()], area = contacts.nodes[i].area;
    if (rows.disc >= 0)
      sum[0] += problem.jump().force(rows.normal, search.bounds[static_cast<std::size_t>(rows.disc)]) *
                felt.segment(rows.normal + 1 - search.first(), rows.tangents).norm();
    sum[1] += area;
    sum[2] += area * normal;
    sum[3] += area * normal * normal;
    sum[4] += search.force[rows.normal];
  }
  problem.communicator().sum_in_place(sums);
  Felt result;
  double scatter = 0;
  for (std::size_t c = 0; c < count; ++c) {
    const double* sum = &sums[c * sums_each];
    result.friction += sum[0];
    if (!(sum[1] > 0)) continue;
    const double mean = sum[2] / sum[1];
    result.alike += mean * sum[4];
    scatter = std::max(scatter, std::sqrt(std::max(sum[3] / sum[1] - mean * mean, 0.0)));
  }
  result.facets = scatter < of_facets * std::sqrt(sagitta) + rounding;
  return result;
}

// The first of the motions of `units` that friction does not hold.
std::optional<std::string> beyond_friction(const Search& search, const BodyRows& rows, const std::vector<std::vector<int>>& units)
{
  constexpr double of_forces = 1e-3;  // what facets make of a weight may work on a motion
  const auto& bodies = search.bodies;
  for (const auto& unit : units)
    for (const auto& motion : motions_of_unit(bodies, rows, search.problem.constraints().contacts, unit, search.sliding_surfaces,
                                              search.problem.communicator())) {
      Eigen::VectorXd amplitudes = Eigen::VectorXd::Zero(bodies.generalised.size());
      double forces = 0;
      for (const auto& part : motion.motions) {
        const auto& frame = bodies.frames[static_cast<std::size_t>(part.body)];
        amplitudes.segment(part.body * bodies.modes, bodies.modes) = amplitudes_of(part, frame, bodies.kinematics);
        forces += bodies.force[part.body];
      }
      double drive = bodies.generalised.dot(amplitudes);
      if (std::abs(drive) <= of_forces * forces) continue;
      if (drive < 0) amplitudes *= -1, drive *= -1;
      const Felt felt = feel(search, amplitudes, motion.sagitta);
      const double missing = drive - felt.alike - felt.friction;
      if (!felt.facets || missing <= std::max(search.slack * felt.friction, of_forces * forces)) continue;
      const auto& part = motion.motions.front();
      return fmt::format("body \"{}\" {}", search.catalogue[static_cast<std::size_t>(part.body)].name,
                         describe(part, bodies.frames[static_cast<std::size_t>(part.body)].radius)) +
             fmt::format("; friction holds {:.3g} % of what drives it, and facets of the mesh are no support",
                         100 * felt.friction / drive);
    }
  return {};
}

}  // namespace

std::optional<std::string> held_by_facets(const DualProblem& problem, const partition::Decomposition& decomposition,
                                          fem::Kinematics kinematics,
                                          std::span<const constraint::SlidingSurface> sliding_surfaces, const Vector& lambda,
                                          std::span<const double> bounds, double slack)
{
  constexpr double at_bound = 1 - 1e-3;
  const auto& comm = problem.communicator();
  const auto& contacts = problem.constraints().contacts;
  if (!comm.any(!bounds.empty())) return {};
  Bodies bodies = aggregate(decomposition, problem.clusters(), kinematics, problem.load(), comm);
  const SparseMatrix g = coarse_rows(problem.jump(), problem.clusters(), comm);
  const BodyRows rows = body_rows(problem.jump(), bodies, g, problem.constraints(),
                                  unknowns(problem.constraints(), problem.jump(), problem.dimension()), comm);
  const Search search{problem,          decomposition.catalogue.bodies, bodies, rows,
                      sliding_surfaces, problem.forces(lambda),         bounds, slack};

  std::vector<bool> rubs(contacts.nodes.size()), slips(contacts.nodes.size()), joins = contacts.bonded;
  for (std::size_t i = 0; i < contacts.nodes.size(); ++i) {
    const auto& node = problem.node_rows()[i];
    rubs[i] = node.disc >= 0;
    if (!rubs[i]) continue;
    const double bound = problem.jump().force(node.normal, bounds[static_cast<std::size_t>(node.disc)]);
    const double force = search.force.segment(node.normal + 1, node.tangents).norm();
    slips[i] = force >= at_bound * bound;
    joins[i] = !slips[i];
  }
  if (auto found = beyond_friction(search, without_friction(search, rubs), units(rows, contacts, contacts.bonded, bodies, comm)))
    return found;
  auto joined = units(rows, contacts, joins, bodies, comm);
  std::erase_if(joined, [](const auto& unit) { return unit.size() < 2; });
  return beyond_friction(search, without_friction(search, slips), joined);
}

}  // namespace mortise::feti
