#include "qp/problem.hpp"

#include <algorithm>

#include "rounding.hpp"

namespace mortise::qp {

double relative_size(const Problem& problem, double tolerance)
{
  double size = 0;
  const auto& [b, e, driven, f, c] = problem.right;
  for (const Vector* v : {&b, driven ? &*driven : nullptr}) {
    if (!v) continue;
    Vector projected(*v, Teuchos::Copy);
    problem.equality.project(projected);
    size = std::max({size, projected.norm2(), rounding_over(tolerance) * v->norm2()});
  }
  return size;
}

}  // namespace mortise::qp
