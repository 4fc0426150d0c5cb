#include "qp/problem.hpp"

#include <algorithm>

namespace mortise::qp {

double relative_size(const Problem& problem, double tolerance)
{
  constexpr double rounding = 1e-13;      // no residual below this part of ||b|| means anything
  constexpr double finest_asked = 1e-10;  // finer tolerances are taken at their word
  double size = 0;
  for (const Vector* v : {&problem.linear, problem.driven}) {
    if (!v) continue;
    Vector projected(*v, Teuchos::Copy);
    problem.equality.project(projected);
    size = std::max({size, projected.norm2(), rounding / std::max(tolerance, finest_asked) * v->norm2()});
  }
  return size;
}

}  // namespace mortise::qp
