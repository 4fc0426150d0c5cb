// The largest eigenvalue of P A P, for the lengths of gradient steps.
#pragma once

#include "qp/problem.hpp"

namespace mortise::qp {

/// An estimate of ||P A P|| from Lanczos steps that start at a random vector of Im P: the largest Ritz value plus its residual
/// bound, once the bound is below `accuracy` of it (at most `max_steps` products). A start vector that misses the dominant
/// eigenvector could still make it too small, so the solver raises it when a direction shows a larger Rayleigh quotient. Where
/// G x = e alone says what x is, P A P is rounding: then the Rayleigh quotient of A at that vector, one product. 0 only for A = 0
/// or without unknowns. Collective.
double projected_norm(Hessian& a, const EqualityConstraint& equality, double accuracy = 0.05, int max_steps = 20);

}  // namespace mortise::qp
