#include "friction/law.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace mortise::friction {

namespace {

constexpr double nothing_part = 1e-10;  // of the bounds of a group, over those of the largest, below which they are none

// What the slip bound of a contact node may depend on.
struct AtNode {
  double area;
  std::optional<double> normal_force;  // none before there is a solution
};

// One row of the table.
struct LawKind {
  Law::Kind kind;
  std::string_view name;  // in the deck
  bool follows_forces;    // the bound is `value` times the normal force
  double (*slip_bound)(double value, const AtNode& at);
};

double without_friction(double /*value*/, const AtNode& /*at*/)
{
  return 0;
}

double tresca(double traction, const AtNode& at)
{
  return traction * at.area;
}

// Before there is a solution every node sticks.
double coulomb(double coefficient, const AtNode& at)
{
  return at.normal_force ? coefficient * std::max(*at.normal_force, 0.0) : std::numeric_limits<double>::infinity();
}

// The table, in the order of Law::Kind.
constexpr std::array laws_of_friction{LawKind{Law::Kind::frictionless, "frictionless", false, without_friction},
                                      LawKind{Law::Kind::tresca, "tresca", false, tresca},
                                      LawKind{Law::Kind::coulomb, "coulomb", true, coulomb}};

const LawKind& kind_of(const Law& law)
{
  return laws_of_friction[static_cast<std::size_t>(law.kind)];
}

}  // namespace

Law law_of(std::string_view name, double value)
{
  for (const auto& row : laws_of_friction)
    if (row.name == name) return {row.kind, value};
  return {Law::Kind::frictionless, value};
}

std::vector<double> slip_bounds(const feti::DualProblem& problem, const std::vector<Law>& laws, const Vector* lambda)
{
  const auto& nodes = problem.constraints().contacts.nodes;
  const Eigen::VectorXd forces = lambda ? problem.forces(*lambda) : Eigen::VectorXd();
  std::vector<double> bounds(problem.set().discs().size(), 0.0);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto& rows = problem.node_rows()[i];
    if (rows.disc < 0) continue;
    const Law& law = laws[static_cast<std::size_t>(nodes[i].contact)];
    const AtNode at{nodes[i].area, lambda ? std::optional(forces[rows.normal]) : std::nullopt};
    bounds[static_cast<std::size_t>(rows.disc)] = kind_of(law).slip_bound(law.value, at);
  }
  return bounds;
}

bool any_coulomb(const std::vector<Law>& laws)
{
  return std::any_of(laws.begin(), laws.end(), [](const Law& law) { return kind_of(law).follows_forces; });
}

qp::FeasibleSet with_coefficients(const feti::DualSystem& system, const std::vector<Law>& laws)
{
  std::vector<double> coefficients(system.set().discs().size(), 0.0);
  for (const auto& rows : system.node_rows())
    if (const Law& law = laws[static_cast<std::size_t>(rows.contact)]; kind_of(law).follows_forces && rows.disc >= 0)
      coefficients[static_cast<std::size_t>(rows.disc)] = law.value;
  auto result = system.set();
  result.set_coefficients(coefficients);
  return result;
}

double relative_change(const feti::DualProblem& problem, const std::vector<double>& next, const std::vector<double>& now,
                       double least)
{
  const auto& groups = problem.system().groups();
  const auto discs = problem.set().discs();
  std::vector<double> squares(2 * groups.of_body.size(), 0.0);  // of each group: of the difference, of the bounds
  for (std::size_t i = 0; i < next.size(); ++i) {
    if (std::isinf(next[i])) continue;
    const auto group = 2 * static_cast<std::size_t>(std::max(groups.of_row[static_cast<std::size_t>(discs[i].index[0])], 0));
    if (!std::isinf(now[i])) squares[group] += (next[i] - now[i]) * (next[i] - now[i]);
    squares[group + 1] += next[i] * next[i];
  }
  problem.communicator().sum_in_place(squares);
  double largest = 0, change = 0;
  for (std::size_t g = 1; g < squares.size(); g += 2) largest = std::max(largest, squares[g]);
  least = std::max(least, nothing_part * std::sqrt(largest));
  for (std::size_t g = 0; g < squares.size(); g += 2) {
    const double size = std::max(std::sqrt(squares[g + 1]), least);
    if (size > 0) change = std::max(change, std::sqrt(squares[g]) / size);
  }
  return change;
}

}  // namespace mortise::friction
