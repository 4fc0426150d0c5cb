// What face Newton does on one face: the linear algebra between two projections.
#include <cmath>

#include "qp/face_newton.hpp"

namespace mortise::qp {

namespace {

constexpr int max_inner = 60;           // steps on one face
constexpr int max_on_only_face = 1000;  // where there are no others

// Less a gradient, as the free directions of a face feel it.
class Residual {
 public:
  Residual(const Face& face, const Vector& gradient) : vector(gradient, Teuchos::Copy), face_(face), scaled_(gradient.getMap())
  {
    vector.scale(-1);
    face.project_gradient(vector);
  }
  // Its norm, slip directions scaled.
  double size()
  {
    scaled_.assign(vector);
    face_.scale(scaled_);
    return scaled_.norm2();
  }

  Vector vector;

 private:
  const Face& face_;
  Vector scaled_;
};

}  // namespace

// z = M residual: the preconditioner between the projectors of the face, improved by all that is known of A from earlier
// directions [Morales and Nocedal, Automatic preconditioning by limited memory quasi-Newton updating, SIAM J. Optim. 10 (2000)].
void FaceNewton::precondition(const Face& face, const Vector& residual, Vector& z) const
{
  Vector q(residual, Teuchos::Copy);
  std::vector<double> part(recycled_.size());
  for (std::size_t i = recycled_.size(); i-- > 0;) {
    part[i] = recycled_[i].direction.dot(q) / recycled_[i].energy;
    q.update(-part[i], recycled_[i].image, 1);
  }
  if (!recycled_.empty()) face.project_gradient(q, 1);  // once is enough for what is projected again at the end
  face.scale(q);
  if (preconditioner_) {
    preconditioner_->apply(q, z);
    ++preconditionings_;
  } else {
    z.update(step_length / norm_, q, 0);
  }
  face.scale(z);
  if (!recycled_.empty()) face.project(z, 1);
  for (std::size_t i = 0; i < recycled_.size(); ++i)
    z.update(part[i] - recycled_[i].image.dot(z) / recycled_[i].energy, recycled_[i].direction, 1);
  face.project(z);
}

void FaceNewton::recycle(std::deque<Pair> fresh)
{
  for (auto& pair : fresh) recycled_.push_back(std::move(pair));
  while (recycled_.size() > kept_) recycled_.pop_front();
}

// Conjugate gradients for min 1/2 d'(A + Sigma) d + g'd over the free directions d of the face; sets y and gy. Returns false if
// there was nothing to do.
bool FaceNewton::descend(const Face& face, double goal, const std::function<void()>& report, State& state)
{
  auto& [z, g, y, gy] = state;
  const auto map = z.getMap();
  y.assign(z);
  gy.assign(g);
  Residual residual(face, g);
  Vector& r = residual.vector;
  Vector direction(map), product(map);
  const double start = residual.size();
  if (start <= 1e-2 * goal) return false;
  if (!only_face_) goal = std::max(goal, inner_reduction * start);
  std::deque<Pair> fresh;
  for (int step = 0; step < (only_face_ ? max_on_only_face : max_inner) && !problem_.hessian.exhausted(); ++step) {
    precondition(face, r, direction);
    for (const auto& pair : fresh) direction.update(-pair.image.dot(direction) / pair.energy, pair.direction, 1);
    problem_.hessian.apply(direction, product);
    Vector image(product, Teuchos::Copy);
    face.add_curvature(direction, image);
    const double energy = direction.dot(image);
    if (!(energy > 0)) break;
    const double length = direction.dot(r) / energy;
    y.update(length, direction, 1);
    gy.update(length, product, 1);
    r.update(-length, image, 1);
    face.project_gradient(r, 1);
    problem_.equality.project(image);
    fresh.push_back({Vector(direction, Teuchos::Copy), std::move(image), energy});
    if (fresh.size() > kept_) fresh.pop_front();
    report();
    if (residual.size() <= goal) break;
  }
  recycle(std::move(fresh));
  return true;
}

// The same where slip bounds follow normal forces: E'(A + Sigma) T is not symmetric, and generalised conjugate residuals
// [Eisenstat, Elman and Schultz, SIAM J. Numer. Anal. 20 (1983)] take the place of conjugate gradients.
bool FaceNewton::descend_coupled(const Face& face, double goal, const std::function<void()>& report, State& state)
{
  auto& [z, g, y, gy] = state;
  const auto map = z.getMap();
  y.assign(z);
  gy.assign(g);
  Residual residual(face, g);
  Vector& r = residual.vector;
  const double start = residual.size();
  if (start <= 1e-2 * goal) return false;
  goal = std::max(goal, inner_reduction * start);
  struct Step {
    Vector direction, product, image;
    double square;
  };
  std::vector<Step> steps;
  std::deque<Pair> fresh;
  for (int count = 0; count < max_inner && !problem_.hessian.exhausted(); ++count) {
    Step next{Vector(map), Vector(map), Vector(map), 0};
    precondition(face, r, next.direction);
    face.project_trial(next.direction);
    problem_.hessian.apply(next.direction, next.product);
    Vector image(next.product, Teuchos::Copy);
    face.add_curvature(next.direction, image);
    Pair pair{Vector(next.direction, Teuchos::Copy), Vector(image, Teuchos::Copy), next.direction.dot(image)};
    problem_.equality.project(pair.image);
    next.image.assign(image);
    face.project_gradient(next.image);
    for (const auto& step : steps) {
      const double part = next.image.dot(step.image) / step.square;
      next.image.update(-part, step.image, 1);
      next.direction.update(-part, step.direction, 1);
      next.product.update(-part, step.product, 1);
    }
    next.square = next.image.dot(next.image);
    if (!(next.square > 0)) break;
    const double length = next.image.dot(r) / next.square;
    y.update(length, next.direction, 1);
    gy.update(length, next.product, 1);
    r.update(-length, next.image, 1);
    if (pair.energy > 0) fresh.push_back(std::move(pair));
    if (fresh.size() > kept_) fresh.pop_front();
    steps.push_back(std::move(next));
    report();
    if (residual.size() <= goal) break;
  }
  recycle(std::move(fresh));
  return true;
}

}  // namespace mortise::qp
