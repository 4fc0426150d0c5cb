#include "feti/preconditioner_kind.hpp"

#include <array>

namespace mortise::feti {

std::span<const PreconditionerKind> preconditioners()
{
  using Kind = Preconditioner::Kind;
  static constexpr std::array table{
      PreconditionerKind{"none", "", {}, false},
      PreconditionerKind{"lumped", "the surface block of the stiffness matrix", Kind::lumped, false},
      PreconditionerKind{"dirichlet", "its Schur complement; fewer products, a second factorization", Kind::dirichlet, true}};
  return table;
}

const PreconditionerKind& preconditioner_kind(std::string_view name)
{
  const auto table = preconditioners();
  for (const auto& kind : table)
    if (kind.name == name) return kind;
  return table.back();
}

}  // namespace mortise::feti
