// What face Newton does on one face: the linear algebra between two projections.
#include <cmath>

#include "qp/face_newton.hpp"

namespace mortise::qp {

namespace {

constexpr int max_inner = 60;           // steps on one face
constexpr int max_on_only_face = 1000;  // where there are no others
constexpr double least_new = 1e-3;      // of a known direction, for a face to use it
constexpr double least_known = 1e-4;    // of x: below, rounding spoils what the difference of two points tells of A

// [E'(A + Sigma) d, weight * held part of d], what a face feels of a direction d; `product`: A d.
Vector felt(const Face& face, const Vector& direction, const Vector& product, double weight, int sweeps)
{
  Vector image(product, Teuchos::Copy), held(direction, Teuchos::Copy);
  face.add_curvature(direction, image);
  face.project_gradient(image, sweeps);
  face.keep_held(held);
  image.update(weight, held, 1);
  return image;
}

// y, which goes along directions whose products are known, as far as the residual on the face falls.
class Descent {
 public:
  // From the point of the face with gradient `gy`.
  Descent(const Face& face, const Communicator& comm, Vector& y, Vector& gy)
      : residual(gy, Teuchos::Copy), face_(face), comm_(comm), y_(y), gy_(gy)
  {
    residual.scale(-1);
    face.project_gradient(residual);
  }
  // What of the residual free directions feel; the rest becomes `held`.
  Vector split(Vector& held) const
  {
    Vector free(residual, Teuchos::Copy);
    face_.keep_free(free);
    held.update(1, residual, -1, free, 0);
    return free;
  }
  // Its norm, slip directions scaled.
  double size() const
  {
    Vector held(residual.getMap());
    Vector free = split(held);
    face_.scale(free);
    return std::hypot(free.norm2(), held.norm2());
  }
  // Generalised conjugate residuals; `image` is what the face feels. False if less than `least` of it is new.
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

  Vector residual;  // in free rows, and in held ones once a direction has left the constraints

 private:
  struct Step {
    Vector direction, product, image;
  };
  const Face& face_;
  const Communicator& comm_;
  Vector &y_, &gy_;
  std::vector<Step> steps_;  // images are orthonormal
};

}  // namespace

// z = M residual: the preconditioner between the projectors of the face, improved by all that is known of A from earlier
// directions [Morales and Nocedal, Automatic preconditioning by limited memory quasi-Newton updating, SIAM J. Optim. 10 (2000)].
void FaceNewton::precondition(const Face& face, const Vector& residual, Vector& z) const
{
  Vector q(residual, Teuchos::Copy);
  std::vector<double> part(known_.size());
  for (std::size_t i = known_.size(); i-- > 0;) {
    if (!known_[i].step) continue;
    part[i] = known_[i].direction.dot(q) / known_[i].energy;
    q.update(-part[i], known_[i].image, 1);
  }
  if (!known_.empty()) face.project_gradient(q, 1);  // once is enough for what is projected again at the end
  face.scale(q);
  if (preconditioner_) {
    preconditioner_->apply(q, z);
    ++preconditionings_;
  } else {
    z.update(step_length / norm_, q, 0);
  }
  face.scale(z);
  if (!known_.empty()) face.project(z, 1);
  for (std::size_t i = 0; i < known_.size(); ++i)
    if (known_[i].step) z.update(part[i] - known_[i].image.dot(z) / known_[i].energy, known_[i].direction, 1);
  face.project(z);
}

void FaceNewton::learn(const Face& face, const Vector& direction, const Vector& product, bool step)
{
  Pair pair{Vector(direction, Teuchos::Copy), Vector(product, Teuchos::Copy), Vector(product, Teuchos::Copy), 0, step};
  if (step) {
    face.add_curvature(direction, pair.image);
    pair.energy = direction.dot(pair.image);
    pair.step = pair.energy > 0;
    problem_.equality.project(pair.image);
  }
  known_.push_back(std::move(pair));
  while (known_.size() > kept_) known_.pop_front();
}

// Conjugate gradients for min 1/2 d'A d + g'd over all d with G d = 0: there are no constraints. Sets y and gy. Returns false if
// there was nothing to do.
bool FaceNewton::descend_alone(const Face& face, double goal, const std::function<void()>& report, State& state)
{
  auto& [z, g, y, gy] = state;
  const auto map = z.getMap();
  y.assign(z);
  gy.assign(g);
  Vector residual(g, Teuchos::Copy), direction(map), product(map);
  residual.scale(-1);
  face.project_gradient(residual);
  if (residual.norm2() <= 1e-2 * goal) return false;
  struct Step {
    Vector direction, image;
    double energy;
  };
  std::deque<Step> steps;  // the last ones: rounding spoils the orthogonality that two would have
  for (int step = 0; step < max_on_only_face && !problem_.hessian.exhausted(); ++step) {
    precondition(face, residual, direction);
    for (const auto& before : steps) direction.update(-before.image.dot(direction) / before.energy, before.direction, 1);
    problem_.hessian.apply(direction, product);
    const double energy = direction.dot(product);
    if (!(energy > 0)) break;
    const double length = direction.dot(residual) / energy;
    y.update(length, direction, 1);
    gy.update(length, product, 1);
    residual.update(-length, product, 1);
    face.project_gradient(residual, 1);
    steps.push_back({Vector(direction, Teuchos::Copy), Vector(product, Teuchos::Copy), energy});
    if (steps.size() > kept_) steps.pop_front();
    report();
    if (residual.norm2() <= goal) break;
  }
  for (const auto& step : steps) learn(face, step.direction, step.image, true);
  return true;
}

// Solves [E'(A + Sigma) d = -E'g, held part of d = 0] on a face, nearly; sets y and gy. Where slip bounds follow normal forces
// that is not symmetric: generalised conjugate residuals [Eisenstat, Elman and Schultz, SIAM J. Numer. Anal. 20 (1983)]. First
// over all known directions, if they are trusted: a face feels A of them as every other, so they cost no product, and that they
// lead off its constraints a little counts as residual, a force times `weight` as a gap. Returns false if there was nothing to
// do.
bool FaceNewton::descend(const Face& face, double goal, double weight, bool trusted, const std::function<void()>& report,
                         State& state)
{
  auto& [z, g, y, gy] = state;
  const auto map = z.getMap();
  Vector direction(z, Teuchos::Copy), product(g, Teuchos::Copy), held(map);
  direction.update(-1, y, 1);  // the projection's step is known as well
  product.update(-1, gy, 1);
  if (direction.norm2() > least_known * z.norm2()) learn(face, direction, product, false);
  y.assign(z);
  gy.assign(g);
  Descent descent(face, problem_.equality.communicator(), y, gy);
  const double start = descent.size();
  if (start <= 1e-2 * goal) return false;
  goal = std::max(goal, inner_reduction * start);
  for (auto pair = known_.rbegin(); trusted && pair != known_.rend(); ++pair)
    descent.go(Vector(pair->direction, Teuchos::Copy), Vector(pair->product, Teuchos::Copy),
               felt(face, pair->direction, pair->product, weight, 1), least_new);
  std::vector<std::pair<Vector, Vector>> fresh;
  for (int step = 0; step < max_inner && descent.size() > goal && !problem_.hessian.exhausted(); ++step) {
    const Vector free = descent.split(held);
    held.scale(1 / weight);
    precondition(face, free, direction);
    face.project_trial(direction, held);
    problem_.hessian.apply(direction, product);
    fresh.emplace_back(Vector(direction, Teuchos::Copy), Vector(product, Teuchos::Copy));
    if (!descent.go(Vector(direction, Teuchos::Copy), Vector(product, Teuchos::Copy), felt(face, direction, product, weight, 2),
                    0))
      break;
    report();
  }
  for (const auto& [d, p] : fresh) learn(face, d, p, true);
  return true;
}

}  // namespace mortise::qp
