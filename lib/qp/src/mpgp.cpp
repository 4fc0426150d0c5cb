#include "qp/mpgp.hpp"

#include <cmath>

namespace mortise::qp {

namespace {

double min_over_ranks(const Vector& x, double value)
{
  double result = value;
  Teuchos::reduceAll(*x.getMap()->getComm(), Teuchos::REDUCE_MIN, 1, &value, &result);
  return result;
}

// x = P_Omega(x - a v).
void gradient_step(const FeasibleSet& set, double a, const Vector& v, Vector& x)
{
  x.update(-a, v, 1);
  set.project(view(x));
}

}  // namespace

double reduced_gradient(const FeasibleSet& set, const Iterate& point, double a)
{
  Vector moved(point.x, Teuchos::Copy);
  gradient_step(set, a, point.gradient, moved);
  moved.update(1, point.x, -1);
  return moved.norm2() / a;
}

void mpgp(const Product& hessian, const FeasibleSet& set, Iterate& point, double& norm, const MpgpOptions& options,
          const std::function<bool(double, const Iterate&)>& done)
{
  auto& [x, g] = point;
  const auto map = x.getMap();
  Vector free(map), chopped(map), direction(map), product(map), linear(map);
  const auto split = [&] { set.split(view(std::as_const(x)), view(std::as_const(g)), view(free), view(chopped)); };
  // g = H x - c; c = H x - g of the point that came in is never formed: a full product renews g from the change of x.
  const auto update = [&](const Vector& from) {
    direction.update(1, x, -1, from, 0);
    hessian(direction, product);
    g.update(1, product, 1);
    split();
    direction.assign(free);
  };
  split();
  direction.assign(free);
  while (!done(reduced_gradient(set, point, options.step / norm), point)) {
    const double free_square = free.dot(free);
    const double chopped_square = chopped.dot(chopped);
    const double gamma = options.proportioning;
    if (chopped_square > gamma * gamma * free_square) {  // proportioning by a gradient projection
      const Vector from(x, Teuchos::Copy);
      gradient_step(set, options.step / norm, g, x);
      update(from);
      continue;
    }
    hessian(direction, product);
    const double curvature = direction.dot(product);
    const double square = direction.dot(direction);
    if (curvature > norm * square) norm = 1.05 * curvature / square;
    const double step = curvature > 0 ? g.dot(direction) / curvature : std::numeric_limits<double>::infinity();
    const double limit = min_over_ranks(x, set.feasible_step(view(std::as_const(x)), view(std::as_const(direction))));
    if (!std::isfinite(std::min(step, limit))) return;  // no curvature and no limit along a direction of descent
    if (step <= limit) {                                // conjugate gradient step
      x.update(-step, direction, 1);
      g.update(-step, product, 1);
      split();
      direction.update(1, free, -free.dot(product) / curvature);
    } else {  // half step to the boundary, then expansion
      x.update(-limit, direction, 1);
      g.update(-limit, product, 1);
      set.project(view(x));  // rounding may have left it an ulp outside
      split();
      const Vector from(x, Teuchos::Copy);
      gradient_step(set, options.step / norm, free, x);
      update(from);
    }
  }
}

}  // namespace mortise::qp
