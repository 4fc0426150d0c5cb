#include "qp/norm.hpp"

#include <cmath>

#include "base/dense.hpp"

namespace mortise::qp {

namespace {

constexpr double nothing = 1e-10;  // part of a vector that G' y leaves of it where nothing is free: rounding

// A number in (-1, 1) that depends on the global index alone, so that every number of ranks starts alike.
double noise(Global index)
{
  auto z = static_cast<unsigned long long>(index) + 0x9e3779b97f4a7c15ULL;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-52 - 1;
}

}  // namespace

double projected_norm(Hessian& a, const EqualityConstraint& equality, double accuracy, int max_steps)
{
  const auto map = a.map();
  Vector v(map), previous(map), w(map);
  {
    auto values = view(v);
    for (Local i = 0; i < values.size(); ++i) values[i] = noise(map->getGlobalElement(i));
  }
  Vector whole(v, Teuchos::Copy);
  equality.project(v);
  const double start = v.norm2(), size = whole.norm2();
  if (size == 0) return 0;
  if (!(start > nothing * size)) {
    a.apply(whole, w);
    return whole.dot(w) / (size * size);
  }
  v.scale(1 / start);

  Eigen::VectorXd diagonal(max_steps), next(max_steps);
  double estimate = 0;
  for (int k = 0; k < max_steps && !a.exhausted(); ++k) {
    a.apply(v, w);
    equality.project(w);
    diagonal[k] = v.dot(w);
    w.update(-diagonal[k], v, k > 0 ? -next[k - 1] : 0.0, previous, 1);
    next[k] = w.norm2();
    const auto ritz = dense::tridiagonal_eigenpairs(diagonal.head(k + 1), next.head(k));
    const double largest = ritz.values[k];
    const double bound = next[k] * std::abs(ritz.vectors(k, k));
    estimate = largest + bound;
    if (bound <= accuracy * largest) break;
    previous.assign(v);
    v.update(1 / next[k], w, 0);
  }
  return estimate;
}

}  // namespace mortise::qp
