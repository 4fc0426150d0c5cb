#include "qp/solver.hpp"

#include <algorithm>
#include <array>

#include "make_solvers.hpp"

namespace mortise::qp {

std::span<const SolverKind> solvers()
{
  static constexpr std::array table{
      SolverKind{.name = "face_newton", .help = "an active set method on exactly projected points", .make = make_face_newton},
      SolverKind{.name = "smalse",
                 .help = "SMALSE-M with MPGP inside, the paper's",
                 .steady = true,
                 .two_residuals = true,
                 .make = make_smalse},
      SolverKind{.name = "direct",
                 .help = "every body one subdomain, the dual operator a matrix, contact solved exactly",
                 .exact_products = true,
                 .whole_bodies = true,
                 .make = make_direct}};
  return table;
}

const SolverKind& solver_kind(std::string_view name)
{
  const auto table = solvers();
  for (const auto& kind : table)
    if (kind.name == name) return kind;
  return table.front();
}

const SolverKind& solver_of_whole_bodies()
{
  const auto table = solvers();
  return *std::ranges::find_if(table, &SolverKind::whole_bodies);
}

}  // namespace mortise::qp
