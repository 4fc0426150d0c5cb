// The way back from multipliers: forces, jumps and slip bounds in the units of the model, displacements, and what they tell.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "body_rows.hpp"
#include "exactly_free.hpp"
#include "feti/dual_problem.hpp"
#include "neutral_motions.hpp"
#include "row_scaling.hpp"

namespace mortise::feti {

Eigen::VectorXd DualProblem::forces(const Vector& lambda) const
{
  return view(lambda).cwiseProduct(RowScaling::of(jump()));
}

Vector DualProblem::multipliers(const Eigen::VectorXd& forces) const
{
  Vector lambda(jump().rows());
  view(lambda) = forces.cwiseQuotient(RowScaling::of(jump()));
  return lambda;
}

Eigen::VectorXd DualProblem::gaps(const Vector& gradient, const Eigen::VectorXd& nu) const
{
  Vector reaction(gradient, Teuchos::Copy);
  equality().add_transpose(1, nu, reaction);
  return view(reaction).cwiseQuotient(RowScaling::of(jump()));
}

Vector DualProblem::gradient(const Eigen::VectorXd& gaps, const Eigen::VectorXd& nu) const
{
  Vector result(jump().rows());
  view(result) = gaps.cwiseProduct(RowScaling::of(jump()));
  equality().add_transpose(-1, nu, result);
  return result;
}

Eigen::VectorXd DualProblem::jumps(const std::vector<Eigen::VectorXd>& u) const
{
  const Vector scaled = jump().apply(u);
  return view(scaled).cwiseQuotient(RowScaling::of(jump()));
}

Eigen::VectorXd DualProblem::given_way(const Vector& lambda) const
{
  return view(lambda).cwiseProduct(RowScaling::compliance_of(jump())).cwiseQuotient(RowScaling::of(jump()));
}

std::vector<double> DualProblem::radii(std::span<const double> slip_bounds) const
{
  std::vector<double> radii(slip_bounds.begin(), slip_bounds.end());
  for (std::size_t i = 0; i < radii.size(); ++i) radii[i] /= RowScaling::of(jump())[set().discs()[i].normal];
  return radii;
}

std::vector<double> DualProblem::slip_bounds(const qp::FeasibleSet& set) const
{
  std::vector<double> forces;
  for (const auto& disc : set.discs()) forces.push_back(RowScaling::of(jump())[disc.normal] * disc.radius);
  return forces;
}

std::vector<Eigen::VectorXd> DualProblem::elastic(const Vector& lambda) const
{
  auto elastic = jump().apply_transpose(lambda);
  for (std::size_t s = 0; s < elastic.size(); ++s) elastic[s] = load()[s] - elastic[s];
  system_->clusters().apply_inverse(elastic);
  return elastic;
}

std::vector<Eigen::VectorXd> DualProblem::displacement(const Vector& lambda, const Eigen::VectorXd& nu) const
{
  return system_->less_motion(elastic(lambda), nu);
}

Eigen::VectorXd DualProblem::least_motion(const Vector& lambda, const Eigen::VectorXd& nu, const std::vector<Eigen::VectorXd>& u,
                                          double negligible_force) const
{
  constexpr double no_force = 1e-9;  // of the largest contact force: the next node may just touch
  // Of that on the lighter body, for what turns, as in drives.cpp: so much loads typed with six digits turn it by, and nodes
  // beside their arc. What a small load lets travel until it meets something stays there.
  constexpr double no_moment = 1e-6;
  // Of the largest jump: beside a gap like this so small a force is an error of the solution.
  constexpr double gap_beside_force = 0.01;
  constexpr Eigen::Index most = 600;  // amplitudes: more would take seconds
  const auto& contacts = constraints_->contacts;
  const auto& comm = communicator();
  const auto& decomposition = system_->decomposition();
  const bool unbonded = std::find(contacts.bonded.begin(), contacts.bonded.end(), false) != contacts.bonded.end();
  if (!comm.any(unbonded)) return nu;
  const Bodies bodies = loaded_bodies(decomposition, system_->clusters(), system_->subdomains().kinematics, load(), comm);
  if (bodies.aggregate.cols() > most) return nu;

  const Local first = jump().ranges().dirichlet, count = jump().ranges().end - first;
  const SparseMatrix felt_by_rows = rows_of_bodies(jump(), equality().local(), bodies);
  const Eigen::VectorXd force = forces(lambda), jump = jumps(u);
  Eigen::VectorXd normal_force = Eigen::VectorXd::Zero(count);
  for (const auto& rows : node_rows()) normal_force[rows.normal - first] = std::abs(force[rows.normal]);
  const double largest = comm.max(count > 0 ? normal_force.maxCoeff() : 0.0);
  double largest_jump = 0;
  for (const auto& rows : node_rows()) largest_jump = std::max(largest_jump, std::abs(jump[rows.normal]));
  largest_jump = comm.max(largest_jump);
  const Eigen::VectorXd now = mean_amplitudes(decomposition, bodies, u, comm);
  // The way back if what turns counts forces as none that travellers do not.
  const auto way_back = [&](const std::vector<bool>& travel) {
    const Eigen::VectorXd on_lighter = largest_on_bodies(felt_by_rows, normal_force, travel, comm);
    FeltMotions felt{felt_by_rows, Eigen::VectorXd::Ones(count),
                     Eigen::VectorXd::Constant(count, std::numeric_limits<double>::infinity())};
    for (std::size_t i = 0; i < contacts.nodes.size(); ++i) {
      const auto& rows = node_rows()[i];
      const Local row = rows.normal - first;
      const double gap = contacts.rows.bound[contacts.nodes[i].row] - jump[rows.normal];
      const bool stands_off = gap > gap_beside_force * largest_jump && force[rows.normal] < no_moment * largest;
      if (contacts.bonded[i] ||
          (!stands_off && force[rows.normal] > std::max({no_force * largest, no_moment * on_lighter[row], negligible_force})))
        continue;
      felt.closed.segment(row, 1 + rows.tangents).setZero();
      felt.gap[row] = gap;
    }
    return towards_rest(felt, now, comm);
  };
  Eigen::VectorXd change = way_back(std::vector<bool>(bodies.frames.size(), false));
  const auto travel = travellers(change, bodies);
  if (std::ranges::find(travel, true) != travel.end()) change = way_back(travel);
  Eigen::VectorXd result = nu;
  result.head(bodies.aggregate.rows()) -= bodies.aggregate * change;
  return result;
}

std::vector<double> DualProblem::loads_of_bodies() const
{
  std::vector<double> loads(system_->decomposition().catalogue.bodies.size(), 0.0);
  for (std::size_t s = 0; s < load().size(); ++s)
    for (Eigen::Index i = 0; i < load()[s].size(); i += dimension())
      loads[static_cast<std::size_t>(system_->decomposition().subdomains[s].body)] += load()[s].segment(i, dimension()).norm();
  communicator().sum_in_place(loads);
  return loads;
}

double DualProblem::imbalance(const std::vector<Eigen::VectorXd>& u, const Vector& lambda, double negligible_force) const
{
  const auto forces = jump().apply_transpose(lambda);
  std::vector<Eigen::VectorXd> given;
  for (std::size_t s = 0; s < forces.size(); ++s) given.push_back(load()[s] - forces[s]);
  const auto inner = system_->clusters().inner_forces(given);
  double residual = 0, size = 0;
  for (std::size_t s = 0; s < u.size(); ++s) {
    residual += (system_->clusters().subdomains()[s]->apply(u[s]) + forces[s] - load()[s] + inner[s]).squaredNorm();
    size += load()[s].squaredNorm() + forces[s].squaredNorm();
    for (Eigen::Index i = 0; i < u[s].size(); ++i) {  // what rounding makes of a rigid motion is no force
      const double k = system_->subdomains().nodal_stiffness[s][static_cast<std::size_t>(i / dimension())];
      size += std::pow(1e-6 * k * u[s][i], 2);
    }
  }
  size = std::max(communicator().sum(size), negligible_force * negligible_force);
  return size > 0 ? std::sqrt(communicator().sum(residual) / size) : 0;
}

std::vector<double> DualProblem::shortenings(const Eigen::VectorXd& nu) const
{
  std::vector<double> result;
  Eigen::Index next = system_->kernel_dimension();
  for (const auto& section : constraints_->pretension_sections)
    result.push_back(section.preload.force ? nu[next++] : section.preload.shortening);
  return result;
}

Eigen::Index DualProblem::first_coupling_motion() const
{
  const auto& sections = constraints_->pretension_sections;
  const auto unknown = [](const auto& section) { return section.preload.force.has_value(); };
  return system_->kernel_dimension() + std::count_if(sections.begin(), sections.end(), unknown);
}

}  // namespace mortise::feti
