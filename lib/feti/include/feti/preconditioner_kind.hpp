// The preconditioners of face Newton, in one table.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "feti/preconditioner.hpp"

namespace mortise::feti {

/// One row of the table.
struct PreconditionerKind {
  std::string_view name;  ///< in the deck
  std::string_view help;
  std::optional<Preconditioner::Kind> kind;  ///< if there is one
  bool factorizes;                           ///< it takes factors of its own besides those of K
};

/// The table. To add a preconditioner: a value of Preconditioner::Kind, what it is in Preconditioner, and a row.
std::span<const PreconditionerKind> preconditioners();

/// The row of a name in the deck.
const PreconditionerKind& preconditioner_kind(std::string_view name);

}  // namespace mortise::feti
