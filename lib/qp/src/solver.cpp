#include "qp/solver.hpp"

#include <array>

#include "make_solvers.hpp"

namespace mortise::qp {

std::span<const SolverKind> solvers()
{
  static constexpr std::array table{
      SolverKind{"face_newton", "an active set method on exactly projected points", false, false, make_face_newton},
      SolverKind{"smalse", "SMALSE-M with MPGP inside, the paper's", true, false, make_smalse},
      SolverKind{"direct", "every body one subdomain, the dual operator a matrix, contact solved exactly", false, true,
                 make_direct}};
  return table;
}

const SolverKind& solver_kind(std::string_view name)
{
  const auto table = solvers();
  for (const auto& kind : table)
    if (kind.name == name) return kind;
  return table.front();
}

}  // namespace mortise::qp
