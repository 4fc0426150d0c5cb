// What is known of a solution beside a point near it.
#pragma once

#include <optional>

#include "qp/solution.hpp"

namespace mortise::qp {

/// `argument`, the projection of which onto Omega is the point but for its residual, tells by its distance from the border of a
/// half-line or a disc how firmly a state is decided; `change` is about what the point is off by.
struct PredictedSolution {
  Vector argument, change;
};

/// By what `preconditioner` makes of the natural residual of `found`; nothing if its projection fails. No product. Collective.
std::optional<PredictedSolution> predict(const Problem& problem, const Solution& found, ActiveSetPreconditioner& preconditioner);

}  // namespace mortise::qp
