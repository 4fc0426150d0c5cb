#include "feti/contact_converged.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "feti/unresolved_nodes.hpp"
#include "pressures.hpp"

namespace mortise::feti {

namespace {

constexpr double known = 0.05;      // change of a pressure over the largest of the contact
constexpr double row_in_space = 4;  // points around n that press: a little more than 2 sqrt(pi n) at a disc of them
constexpr double row_in_planes = 2;
constexpr double part_of_row = 0.1;  // that may be open: a tenth of a cell at the rim

constexpr double force_known = 0.1;  // change of a contact's force over that force
constexpr double no_force = 1e-3;    // over the least load of a body, or the largest force of a contact where none is loaded

}  // namespace

bool contact_converged(const DualProblem& problem, const Vector& x, const Vector& argument, const Vector& change)
{
  const auto& comm = problem.communicator();
  const auto& nodes = problem.constraints().contacts.nodes;
  const auto& bonded = problem.constraints().contacts.bonded;
  const Eigen::VectorXd differs = problem.forces(change), firmly = problem.forces(argument);
  const Pressures pressures(problem, x);
  const auto count = pressures.parts();
  std::vector<double> moved(count, 0.0), pressed(count, 0.0), undecided(count, 0.0);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (bonded[i]) continue;
    const auto& rows = problem.node_rows()[i];
    const auto c = pressures.part_of(i);
    const double off = differs[rows.normal];
    pressed[c] += view(x)[rows.normal] > 0;
    double square = off * off;
    for (int t = 1; t <= rows.tangents; ++t) square += differs[rows.normal + t] * differs[rows.normal + t];
    moved[c] = std::max(moved[c], pressures.of(i, std::sqrt(square)));
    undecided[c] += std::abs(off) >= std::abs(firmly[rows.normal]) &&
                    pressures.of(i, std::abs(off)) > negligible_change * pressures.largest(c);
  }
  comm.sum_in_place(pressed);
  comm.sum_in_place(undecided);
  for (auto& v : moved) v = comm.max(v);
  for (std::size_t c = 0; c < count; ++c) {
    if (pressures.idle(c)) continue;
    const double row = problem.dimension() == 3 ? row_in_space * std::sqrt(pressed[c]) : row_in_planes;
    if (moved[c] > known * pressures.largest(c) || undecided[c] > part_of_row * row) return false;
  }
  return true;
}

bool contact_forces_known(const DualProblem& problem, const Vector& x, const Vector& change)
{
  const auto& bonded = problem.constraints().contacts.bonded;
  const Eigen::VectorXd differs = problem.forces(change);
  const Pressures pressures(problem, x);
  std::vector<double> moved(pressures.parts(), 0.0);
  for (std::size_t i = 0; i < bonded.size(); ++i)
    if (!bonded[i]) moved[pressures.part_of(i)] += differs[problem.node_rows()[i].normal];
  problem.communicator().sum_in_place(moved);
  for (std::size_t c = 0; c < moved.size(); ++c)
    if (std::abs(moved[c]) > force_known * std::max(pressures.force(c), pressures.force_that_counts(c))) return false;
  return true;
}

}  // namespace mortise::feti
