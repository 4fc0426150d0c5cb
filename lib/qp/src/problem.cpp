#include "qp/problem.hpp"

#include <algorithm>

#include "rounding.hpp"

namespace mortise::qp {

double relative_size(const Problem& problem, double tolerance)
{
  double size = 0;
  for (const Vector* v : {&problem.linear, problem.driven}) {
    if (!v) continue;
    Vector projected(*v, Teuchos::Copy);
    problem.equality.project(projected);
    size = std::max({size, projected.norm2(), rounding_over(tolerance) * v->norm2()});
  }
  return size;
}

}  // namespace mortise::qp
