#include "post/balance.hpp"

#include <algorithm>
#include <cmath>

#include "contact/cyclic.hpp"

namespace mortise::post {

namespace {

// Of what nodal stiffness makes of displacements.
constexpr double part_of_stiffness = 1e-12;
// The same of forces, of which a thousandth still counts in their balance: a solver's tolerance goes by what prescribed motions
// would take if nothing else moved.
constexpr double part_of_stiffness_in_forces = 1e-9;
// Of a model's size: displacements below it are none. A body at rest, lifted clear of all others, has forces of rounding alone.
constexpr double part_of_size = 1e-12;
// Of loads at nodes that cancel, as those of warmth do. Sums of dense matrices' rows have larger ones than those of elements.
constexpr double part_of_loads = 1e-11;
// Of the displacements that loads would have if each node resisted alone, a body's own being at least some tenths of them: what
// is below is nothing.
constexpr double part_of_displacement = 1e-6, part_of_overlap = 1e-5;
// Of the largest displacement: one that is nothing in the states after it, where supports are back where they began.
constexpr double part_of_motion = 1e-6;
// Of forces at contact nodes that cancel, as those of a fit do: what rounding leaves of them, times a thousand, and what warnings
// measure other forces by.
constexpr double part_of_contacts = 1e-6, acting_part_of_contacts = 1e-3;

}  // namespace

std::vector<Reaction> reactions(const feti::DualProblem& problem, const Vector& lambda, std::size_t supports)
{
  std::vector<double> sums((supports + 1) * 6, 0.0);  // the last for an axis of revolution
  const auto add = [&](int support, const std::array<double, 3>& at, const Point& force) {
    const Point moment = Point(at[0], at[1], at[2]).cross(force);
    double* const sum = &sums[static_cast<std::size_t>(support) * 6];
    for (int c = 0; c < 3; ++c) sum[c] += force[c], sum[3 + c] += moment[c];
  };
  const Eigen::VectorXd forces = problem.forces(lambda);
  const auto& ranges = problem.jump().ranges();
  const auto& prescribed = problem.constraints().prescribed;
  for (std::size_t i = 0; i < prescribed.size(); ++i)
    if (const auto& row = prescribed[i]; row.coupling < 0)
      add(row.support, row.at, -forces[ranges.dirichlet + static_cast<Local>(i)] * Point::Unit(row.component));
  const auto& skew_supports = problem.constraints().skew_supports;
  for (std::size_t i = 0; i < skew_supports.size(); ++i) {
    const auto& row = skew_supports[i];
    const double force = forces[ranges.dirichlet + static_cast<Local>(prescribed.size() + i)];
    for (const auto& share : std::span(row.shares).first(static_cast<std::size_t>(row.share_count)))
      add(share.support, row.at, -force * Point(share.part[0], share.part[1], share.part[2]));
  }
  const auto& springs = problem.constraints().springs;
  for (std::size_t i = 0; i < springs.own.size(); ++i) {
    const auto& row = springs.rows[springs.own[i]];
    const double force = forces[ranges.springs + static_cast<Local>(i)];
    if (row.support >= 0) add(row.support, row.at, -force * Point(row.direction[0], row.direction[1], row.direction[2]));
  }
  for (const auto& entry : problem.constraints().contacts.prescribed)  // contact forces that go straight into supports
    if (entry.coupling < 0)
      add(entry.support, entry.at,
          entry.coefficient * forces[ranges.contacts + static_cast<Local>(entry.row)] * Point::Unit(entry.component));
  problem.communicator().sum_in_place(sums);
  std::vector<Reaction> result(supports);
  for (std::size_t s = 0; s < supports; ++s) {
    std::copy_n(&sums[6 * s], 3, result[s].force.begin());
    std::copy_n(&sums[6 * s + 3], 3, result[s].moment.begin());
  }
  return result;
}

std::vector<CouplingState> coupling_states(const feti::DualProblem& problem, const Vector& lambda)
{
  const auto& constraints = problem.constraints();
  const Eigen::VectorXd forces = problem.forces(lambda);
  const auto first = problem.jump().ranges().dirichlet;
  std::vector<double> sums(6 * constraints.couplings.size(), 0.0);
  const auto add = [&](const auto& row, double size) {  // a row or an entry of one
    if (row.coupling < 0) return;
    const Point force = size * Point::Unit(row.component);
    const Point moment = Point(row.arm[0], row.arm[1], row.arm[2]).cross(force);
    double* const sum = &sums[6 * static_cast<std::size_t>(row.coupling)];
    for (int c = 0; c < 3; ++c) sum[c] += force[c], sum[3 + c] += moment[c];
  };
  for (std::size_t i = 0; i < constraints.prescribed.size(); ++i)
    add(constraints.prescribed[i], -forces[first + static_cast<Local>(i)]);
  for (const auto& entry : constraints.contacts.prescribed)
    add(entry, entry.coefficient * forces[problem.jump().ranges().contacts + static_cast<Local>(entry.row)]);
  const auto means = first + static_cast<Local>(constraints.prescribed.size() + constraints.skew_supports.size());
  for (std::size_t i = 0; i < constraints.mean_motions.size(); ++i) {
    const auto& row = constraints.mean_motions[i];
    const auto coupling = static_cast<std::size_t>(row.coupling);
    const double size = -forces[means + static_cast<Local>(i)];
    double* const sum = &sums[6 * coupling];
    // On the boundary of one sector a moment about their axis pushes across it as well.
    for (const auto& entry : row.entries) sum[entry.component] += entry.coefficient * size;
    if (row.component >= 3) sum[row.component] += constraints.couplings[coupling].arm * size;
  }
  problem.communicator().sum_in_place(sums);
  std::vector<CouplingState> result;
  for (std::size_t i = 0; i < constraints.couplings.size(); ++i) {
    const auto& coupling = constraints.couplings[i];
    auto& state = result.emplace_back();
    std::copy_n(&sums[6 * i], 6, state.action.begin());
    for (std::size_t k = 0; k < 6; ++k) {
      if (!coupling.rigid) state.action[k] += coupling.load[k];
      state.reaction[k] = state.action[k] - coupling.load[k];
    }
  }
  return result;
}

std::vector<SpringState> spring_states(const feti::DualProblem& problem, const Vector& lambda)
{
  const auto& springs = problem.constraints().springs;
  std::size_t count = 0;  // every rank has all rows
  for (const auto& row : springs.rows) count = std::max(count, static_cast<std::size_t>(row.spring + 1));
  const Eigen::VectorXd forces = problem.forces(lambda);
  std::vector<double> found(2 * count, 0.0);
  for (std::size_t i = 0; i < springs.own.size(); ++i) {
    const auto number = springs.own[i];
    if (springs.rows[number].spring < 0) continue;
    const double force = forces[problem.jump().ranges().springs + static_cast<Local>(i)];
    double* const state = &found[2 * static_cast<std::size_t>(springs.rows[number].spring)];
    state[0] = force;
    state[1] = force / springs.stiffness.coeff(static_cast<int>(number), static_cast<int>(number));
  }
  problem.communicator().sum_in_place(found);
  std::vector<SpringState> result;
  for (std::size_t s = 0; s < count; ++s) result.push_back({found[2 * s], found[2 * s + 1]});
  return result;
}

void Rounding::take(const Rounding& other)
{
  force = std::max(force, other.force);
  energy = std::max(energy, other.energy);
  length = std::max(length, other.length);
  moved = std::max(moved, other.moved);
}

Rounding rounding(const std::vector<Eigen::VectorXd>& displacement, const std::vector<Eigen::VectorXd>& load,
                  const std::vector<std::vector<double>>& nodal_stiffness, int dimension, double size, const Communicator& comm)
{
  // k |u| and k |u|^2 / 2: forces and energy if nothing moved with its neighbours; |f|^2 / 2k: energy if nodes held themselves.
  std::array<double, 3> sums{0, 0, 0};
  double longest = 0, stiffest = 0, farthest = 0;  // |f| / k, k, |u|
  for (std::size_t s = 0; s < displacement.size(); ++s)
    for (Eigen::Index i = 0; i < displacement[s].size(); i += dimension) {
      const double length = displacement[s].segment(i, dimension).norm();
      const double k = nodal_stiffness[s][static_cast<std::size_t>(i / dimension)];
      sums[0] += k * length;
      sums[1] += 0.5 * k * length * length;
      sums[2] += 0.5 * load[s].segment(i, dimension).squaredNorm() / k;
      stiffest = std::max(stiffest, k);
      farthest = std::max(farthest, length);
      longest = std::max(longest, load[s].segment(i, dimension).norm() / k);
    }
  comm.sum_in_place(sums);
  const double nothing = part_of_size * size;
  stiffest = comm.max(stiffest);
  return {std::max(part_of_stiffness_in_forces * sums[0], stiffest * nothing),
          std::max(part_of_displacement * part_of_displacement * sums[2], 0.5 * stiffest * nothing * nothing),
          std::max({part_of_overlap * comm.max(longest), part_of_motion * comm.max(farthest), nothing}),
          part_of_overlap * sums[2], part_of_stiffness * sums[1]};
}

Balance balance(const feti::DualProblem& problem, const Vector& lambda, std::span<const Reaction> reactions,
                std::span<const contact::Resultant> contacts, std::span<const contact::Pair> pairs, bool axisymmetric,
                std::span<const CouplingState> couplings, const Rounding& rounding)
{
  const auto& comm = problem.communicator();
  const auto counted = [&](const auto& f) { return Point(axisymmetric ? 0 : f[0], f[1], f[2]); };
  std::vector<double> applied(4, 0.0);  // and the sum of sizes
  for (const auto& f : problem.load()) {
    for (Eigen::Index i = 0; i < f.size(); ++i) applied[static_cast<std::size_t>(i % problem.dimension())] += f[i];
    applied[3] += f.lpNorm<1>();
  }
  comm.sum_in_place(applied);
  Balance b;
  b.applied = counted(applied);
  for (const auto& reaction : reactions) b.supports += counted(reaction.force);
  for (std::size_t i = 0; i < couplings.size(); ++i) {
    const auto& coupling = problem.constraints().couplings[i];
    if (coupling.rigid) b.applied += counted(coupling.load);
    b.supports += counted(couplings[i].reaction);
  }
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const auto& options = pairs[c].options;
    if (const auto rotation = contact::rotation_of(options))
      b.neighbours += contacts[c].force - rotation->rotation.transpose() * contacts[c].force;
    if (options.obstacle) b.obstacles += counted(contacts[c].force);
  }
  b.largest = std::max({b.applied.norm(), b.supports.norm(), rounding.force, part_of_loads * applied[3], 1e-300});
  for (const auto& r : contacts) b.largest = std::max({b.largest, r.force.norm(), part_of_contacts * r.sizes});
  for (const auto& c : couplings) b.largest = std::max(b.largest, std::hypot(c.action[0], c.action[1], c.action[2]));
  for (const auto& [force, moment] : reactions) b.largest = std::max(b.largest, std::hypot(force[0], force[1], force[2]));
  b.gauges = problem.system().gauge_force(lambda);
  b.difference = (b.applied + b.supports + b.obstacles + b.neighbours + b.gauges).norm() / b.largest;
  b.acting = b.largest;
  for (const auto& r : contacts) b.acting = std::max(b.acting, acting_part_of_contacts * r.sizes);
  b.push_of_facets = b.gauges.norm() / b.acting;
  return b;
}

}  // namespace mortise::post
