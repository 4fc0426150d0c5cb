// What face Newton does on one active set: the linear algebra between two projections.
#include <cmath>

#include "qp/face_newton.hpp"

namespace mortise::qp {

namespace {

constexpr int max_inner = 60;            // steps on one active set
constexpr int max_unconstrained = 1000;  // where there are no others
constexpr double least_new = 1e-3;       // of a recycled direction, for an active set to use it
constexpr double least_recycled = 1e-4;  // of x: below, rounding spoils what the difference of two points tells of A

// [E'(A + Sigma) d, weight * constrained part of d], what an active set feels of a direction d; `product`: A d.
Vector projected_image(const ActiveSet& active_set, const Vector& direction, const Vector& product, double weight, int sweeps)
{
  Vector image(product, Teuchos::Copy), constrained(direction, Teuchos::Copy);
  active_set.add_curvature(direction, image);
  active_set.project_gradient(image, sweeps);
  active_set.keep_constrained(constrained);
  image.update(weight, constrained, 1);
  return image;
}

// y, which goes along directions whose products are known, as far as the residual on the active set falls.
class Descent {
 public:
  // From the point of the active set with gradient `gy`.
  Descent(const ActiveSet& active_set, const Communicator& comm, Vector& y, Vector& gy)
      : residual(gy, Teuchos::Copy), active_set_(active_set), comm_(comm), y_(y), gy_(gy)
  {
    residual.scale(-1);
    active_set.project_gradient(residual);
  }
  // What of the residual free directions feel; the rest becomes `constrained`.
  Vector split(Vector& constrained) const
  {
    Vector free(residual, Teuchos::Copy);
    active_set_.keep_free(free);
    constrained.update(1, residual, -1, free, 0);
    return free;
  }
  // Its norm, slip directions scaled.
  double size() const
  {
    Vector constrained(residual.getMap());
    Vector free = split(constrained);
    active_set_.scale(free);
    return std::hypot(free.norm2(), constrained.norm2());
  }
  // Generalised conjugate residuals; `image` is what the active set feels. False if less than `least` of it is new.
  bool go(Vector direction, Vector product, Vector image, double least)
  {
    const double whole = image.norm2();
    std::vector<double> part(steps_.size());
    for (int sweep = 0; sweep < 2 && !steps_.empty(); ++sweep) {  // Gram and Schmidt, twice: one sum over the ranks each
      for (std::size_t i = 0; i < steps_.size(); ++i)
        part[i] = view(std::as_const(image)).dot(view(std::as_const(steps_[i].image)));
      comm_.sum_in_place(part);
      for (std::size_t i = 0; i < steps_.size(); ++i) {
        image.update(-part[i], steps_[i].image, 1);
        direction.update(-part[i], steps_[i].direction, 1);
        product.update(-part[i], steps_[i].product, 1);
      }
    }
    const double size = image.norm2();
    if (!(size > least * whole)) return false;
    for (Vector* v : {&direction, &product, &image}) v->scale(1 / size);
    const double length = image.dot(residual);
    y_.update(length, direction, 1);
    gy_.update(length, product, 1);
    residual.update(-length, image, 1);
    steps_.push_back({std::move(direction), std::move(product), std::move(image)});
    return true;
  }

  Vector residual;  // in free rows, and in constrained ones once a direction has left the constraints

 private:
  struct Step {
    Vector direction, product, image;
  };
  const ActiveSet& active_set_;
  const Communicator& comm_;
  Vector &y_, &gy_;
  std::vector<Step> steps_;  // images are orthonormal
};

}  // namespace

// z = M residual: the preconditioner between the projectors of the active set, improved by all that is known of A from earlier
// directions [Morales and Nocedal, Automatic preconditioning by limited memory quasi-Newton updating, SIAM J. Optim. 10 (2000)].
void FaceNewton::precondition(const ActiveSet& active_set, const Vector& residual, Vector& z) const
{
  Vector q(residual, Teuchos::Copy);
  std::vector<double> part(recycled_directions_.size());
  for (std::size_t i = recycled_directions_.size(); i-- > 0;) {
    if (!recycled_directions_[i].step) continue;
    part[i] = recycled_directions_[i].direction.dot(q) / recycled_directions_[i].energy;
    q.update(-part[i], recycled_directions_[i].image, 1);
  }
  if (!recycled_directions_.empty()) active_set.project_gradient(q, 1);  // once is enough for what is projected again at the end
  active_set.scale(q);
  if (preconditioner_) {
    preconditioner_->apply(q, z);
    ++preconditionings_;
  } else {
    z.update(step_length / norm_, q, 0);
  }
  active_set.scale(z);
  if (!recycled_directions_.empty()) active_set.project(z, 1);
  for (std::size_t i = 0; i < recycled_directions_.size(); ++i)
    if (recycled_directions_[i].step)
      z.update(part[i] - recycled_directions_[i].image.dot(z) / recycled_directions_[i].energy, recycled_directions_[i].direction,
               1);
  active_set.project(z);
}

void FaceNewton::recycle(const ActiveSet& active_set, const Vector& direction, const Vector& product, bool step)
{
  Pair pair{Vector(direction, Teuchos::Copy), Vector(product, Teuchos::Copy), Vector(product, Teuchos::Copy), 0, step};
  if (step) {
    active_set.add_curvature(direction, pair.image);
    pair.energy = direction.dot(pair.image);
    pair.step = pair.energy > 0;
    problem_.equality.project(pair.image);
  }
  recycled_directions_.push_back(std::move(pair));
  while (recycled_directions_.size() > kept_) recycled_directions_.pop_front();
}

// Conjugate gradients for min 1/2 d'A d + g'd over all d with G d = 0: there are no constraints. Sets y and gy. Returns false if
// there was nothing to do.
bool FaceNewton::descend_alone(const ActiveSet& active_set, double goal, const std::function<void()>& report, State& state)
{
  auto& [z, g, y, gy] = state;
  const auto map = z.getMap();
  y.assign(z);
  gy.assign(g);
  Vector residual(g, Teuchos::Copy), direction(map), product(map);
  residual.scale(-1);
  active_set.project_gradient(residual);
  if (residual.norm2() <= 1e-2 * goal) return false;
  struct Step {
    Vector direction, image;
    double energy;
  };
  std::deque<Step> steps;  // the last ones: rounding spoils the orthogonality that two would have
  for (int step = 0; step < max_unconstrained && !problem_.hessian.exhausted(); ++step) {
    precondition(active_set, residual, direction);
    for (const auto& before : steps) direction.update(-before.image.dot(direction) / before.energy, before.direction, 1);
    problem_.hessian.apply(direction, product);
    const double energy = direction.dot(product);
    if (!(energy > 0)) break;
    const double length = direction.dot(residual) / energy;
    y.update(length, direction, 1);
    gy.update(length, product, 1);
    residual.update(-length, product, 1);
    active_set.project_gradient(residual, 1);
    steps.push_back({Vector(direction, Teuchos::Copy), Vector(product, Teuchos::Copy), energy});
    if (steps.size() > kept_) steps.pop_front();
    report();
    if (residual.norm2() <= goal) break;
  }
  for (const auto& step : steps) recycle(active_set, step.direction, step.image, true);
  return true;
}

// Solves [E'(A + Sigma) d = -E'g, constrained part of d = 0] on an active set, nearly; sets y and gy. Where slip bounds follow
// normal forces that is not symmetric: generalised conjugate residuals [Eisenstat, Elman and Schultz, SIAM J. Numer. Anal. 20
// (1983)]. First over all recycled directions, if they are trusted: an active set feels A of them as every other, so they cost no
// product, and that they lead off its constraints a little counts as residual, a force times `weight` as a gap. Returns false if
// there was nothing to do.
bool FaceNewton::descend(const ActiveSet& active_set, double goal, double weight, bool trusted,
                         const std::function<void()>& report, State& state)
{
  auto& [z, g, y, gy] = state;
  const auto map = z.getMap();
  Vector direction(z, Teuchos::Copy), product(g, Teuchos::Copy), constrained(map);
  direction.update(-1, y, 1);  // the projection's step is known as well
  product.update(-1, gy, 1);
  if (direction.norm2() > least_recycled * z.norm2()) recycle(active_set, direction, product, false);
  y.assign(z);
  gy.assign(g);
  Descent descent(active_set, problem_.equality.communicator(), y, gy);
  const double start = descent.size();
  if (start <= 1e-2 * goal) return false;
  goal = std::max(goal, inner_reduction * start);
  for (auto pair = recycled_directions_.rbegin(); trusted && pair != recycled_directions_.rend(); ++pair)
    descent.go(Vector(pair->direction, Teuchos::Copy), Vector(pair->product, Teuchos::Copy),
               projected_image(active_set, pair->direction, pair->product, weight, 1), least_new);
  std::vector<std::pair<Vector, Vector>> fresh;
  for (int step = 0; step < max_inner && descent.size() > goal && !problem_.hessian.exhausted(); ++step) {
    const Vector free = descent.split(constrained);
    constrained.scale(1 / weight);
    precondition(active_set, free, direction);
    active_set.project_trial(direction, constrained);
    problem_.hessian.apply(direction, product);
    fresh.emplace_back(Vector(direction, Teuchos::Copy), Vector(product, Teuchos::Copy));
    if (!descent.go(Vector(direction, Teuchos::Copy), Vector(product, Teuchos::Copy),
                    projected_image(active_set, direction, product, weight, 2), 0))
      break;
    report();
  }
  for (const auto& [d, p] : fresh) recycle(active_set, d, p, true);
  return true;
}

}  // namespace mortise::qp
