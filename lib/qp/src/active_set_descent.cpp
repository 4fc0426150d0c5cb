// What face Newton does on one active set: the linear algebra between two projections.
#include <algorithm>
#include <cmath>
#include <deque>
#include <span>
#include <vector>

#include "orthonormal_columns.hpp"
#include "qp/face_newton.hpp"

namespace mortise::qp {

namespace {

constexpr double least_new = 1e-3;       // of a recycled direction, for an active set to use it
constexpr double least_recycled = 1e-4;  // of x: below, rounding spoils what the difference of two points tells of A

// [E'(A + Sigma) d, weight * constrained part of d], what an active set feels of a direction d; `product`: A d.
Vector projected_image(const ActiveSet& active_set, const Vector& direction, const Vector& product, double weight, int sweeps)
{
  Vector image(product, Teuchos::Copy);
  active_set.add_curvature(direction, image);
  active_set.project_gradient(image, sweeps);
  active_set.add_constrained(weight, direction, image);
  return image;
}

// Vectors of one length, that of this rank. What is done with many of them at once goes through them in parts that fit in a
// cache, so that the other operand is read once.
class Columns {
 public:
  std::size_t size() const { return columns_.size(); }
  void push_back(const Vector& v) { columns_.push_back(view(v).data()); }
  void push_back(const double* v) { columns_.push_back(v); }

  // x += sum of factor[i] v_i.
  void add(const Eigen::VectorXd& factor, Vector& x) const
  {
    auto values = view(x);
    for_each_part(values.size(), [&](Eigen::Index first, Eigen::Index count) { add_part(factor, values, first, count); });
  }
  // The dot products v_i'x on this rank.
  Eigen::VectorXd dots(const Vector& x) const
  {
    const auto values = view(x);
    Eigen::VectorXd result = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(size()));
    for_each_part(values.size(), [&](Eigen::Index first, Eigen::Index count) { add_dots(values, first, count, result); });
    return result;
  }
  // Both in one pass: add(), and the dot products with what x has become.
  Eigen::VectorXd add_then_dots(const Eigen::VectorXd& factor, Vector& x) const
  {
    auto values = view(x);
    Eigen::VectorXd result = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(size()));
    for_each_part(values.size(), [&](Eigen::Index first, Eigen::Index count) {
      add_part(factor, values, first, count);
      add_dots(values, first, count, result);
    });
    return result;
  }

 private:
  static constexpr Eigen::Index part = 1024;

  template <class Visit>
  static void for_each_part(Eigen::Index size, const Visit& visit)
  {
    for (Eigen::Index first = 0; first < size; first += part) visit(first, std::min(part, size - first));
  }
  Eigen::Map<const Eigen::VectorXd> column(std::size_t i, Eigen::Index first, Eigen::Index count) const
  {
    return {columns_[i] + first, count};
  }
  template <class Values>
  void add_part(const Eigen::VectorXd& factor, Values& values, Eigen::Index first, Eigen::Index count) const
  {
    for (std::size_t i = 0; i < size(); ++i)
      values.segment(first, count) += factor[static_cast<Eigen::Index>(i)] * column(i, first, count);
  }
  template <class Values>
  void add_dots(const Values& values, Eigen::Index first, Eigen::Index count, Eigen::VectorXd& result) const
  {
    for (std::size_t i = 0; i < size(); ++i)
      result[static_cast<Eigen::Index>(i)] += column(i, first, count).dot(values.segment(first, count));
  }

  std::vector<const double*> columns_;
};

// y, which goes along directions whose products are known, as far as the residual on the active set falls. With the images of
// the directions D as columns, images = Q R, Q'Q = I, it goes by D R^-1 Q' residual.
class Descent {
 public:
  // From the point of the active set with gradient `gy`. `curved`: the preconditioner knows the curvatures.
  Descent(const ActiveSet& active_set, const Communicator& comm, bool curved, const Vector& gy)
      : residual(gy, Teuchos::Copy), active_set_(active_set), comm_(comm), curved_(curved)
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
  // Its norm, slip directions scaled where nothing else knows their curvatures.
  double size() const
  {
    if (curved_) return residual.norm2();
    Vector constrained(residual.getMap());
    Vector free = split(constrained);
    active_set_.scale(free);
    return std::hypot(free.norm2(), constrained.norm2());
  }
  // Generalised conjugate residuals; `image` is what the active set feels. False if less than `least` of it is new. `direction`
  // and `product` must stay where they are.
  bool go(const Vector& direction, const Vector& product, Vector image, double least)
  {
    const double whole = image.norm2();
    Eigen::VectorXd coefficient = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(columns_.size()));
    if (columns_.size() > 0) {  // Gram and Schmidt, twice: one sum over the ranks each
      Eigen::VectorXd part = columns_.dots(image);
      sum(part);
      coefficient = part;
      part = columns_.add_then_dots(-part, image);
      sum(part);
      coefficient += part;
      columns_.add(-part, image);
    }
    const double size = image.norm2();
    if (!(size > least * whole)) return false;
    image.scale(1 / size);
    const double length = image.dot(residual);
    residual.update(-length, image, 1);
    images_.push_back(std::move(image));
    columns_.push_back(images_.back());
    directions_.push_back(direction);
    products_.push_back(product);
    coefficient.conservativeResize(coefficient.size() + 1);
    coefficient.tail(1)[0] = size;
    triangle_.push_back(std::move(coefficient));
    lengths_.push_back(length);
    return true;
  }
  // The same with many at once, before all others. They give their direction and their product, and `images` one column each.
  void go(std::span<const std::pair<const Vector*, const Vector*>> moves, Eigen::MatrixXd images, double least)
  {
    if (moves.empty()) return;
    first_ = orthonormal_columns(std::move(images), least, comm_);
    Eigen::VectorXd length = first_.q.transpose() * view(residual);
    sum(length);
    view(residual) -= first_.q * length;
    for (Eigen::Index k = 0; k < length.size(); ++k) {
      const auto& [direction, product] = moves[static_cast<std::size_t>(first_.kept[static_cast<std::size_t>(k)])];
      columns_.push_back(first_.q.col(k).data());
      directions_.push_back(*direction);
      products_.push_back(*product);
      triangle_.emplace_back(first_.r.col(k).head(k + 1));
      lengths_.push_back(length[k]);
    }
  }
  // Takes y along all of them, and gy = A y - b with it.
  void finish(Vector& y, Vector& gy) const
  {
    Eigen::VectorXd x = Eigen::Map<const Eigen::VectorXd>(lengths_.data(), static_cast<Eigen::Index>(lengths_.size()));
    for (Eigen::Index j = x.size() - 1; j >= 0; --j) {
      const auto& column = triangle_[static_cast<std::size_t>(j)];
      x[j] /= column[j];
      x.head(j) -= x[j] * column.head(j);
    }
    directions_.add(x, y);
    products_.add(x, gy);
  }

  Vector residual;  // in free rows, and in constrained ones once a direction has left the constraints

 private:
  void sum(Eigen::VectorXd& part) const { comm_.sum_in_place({part.data(), static_cast<std::size_t>(part.size())}); }

  const ActiveSet& active_set_;
  const Communicator& comm_;
  bool curved_;
  OrthonormalColumns first_;    // the first columns of Q
  std::vector<Vector> images_;  // the others
  Columns columns_, directions_, products_;
  std::vector<Eigen::VectorXd> triangle_;  // R by columns
  std::vector<double> lengths_;            // Q'residual
};

}  // namespace

// z = M residual, to be projected once more: the preconditioner between the projectors of the active set, improved by all that
// is known of A from earlier directions [Morales and Nocedal, Automatic preconditioning by limited memory quasi-Newton updating,
// SIAM J. Optim. 10 (2000)].
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
  const auto scale = [&](Vector& x) {
    if (preconditioner_ && preconditioner_->knows_curvature())
      active_set.keep_free(x);
    else
      active_set.scale(x);
  };
  scale(q);
  if (preconditioner_) {
    preconditioner_->apply(q, z);
    ++preconditionings_;
  } else {
    z.update(step_length / norm_, q, 0);
  }
  scale(z);
  if (!recycled_directions_.empty()) active_set.project(z, 1);
  for (std::size_t i = 0; i < recycled_directions_.size(); ++i)
    if (recycled_directions_[i].step)
      z.update(part[i] - recycled_directions_[i].image.dot(z) / recycled_directions_[i].energy, recycled_directions_[i].direction,
               1);
}

// Keeps the two vectors.
void FaceNewton::recycle(const ActiveSet& active_set, Vector direction, Vector product, bool step)
{
  Vector image(product, Teuchos::Copy);
  Pair pair{std::move(direction), std::move(product), std::move(image), 0, step};
  if (step) {
    active_set.add_curvature(pair.direction, pair.image);
    pair.energy = pair.direction.dot(pair.image);
    pair.step = pair.energy > 0;
    programme_.equality.project(pair.image);
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
  if (residual.norm2() <= Limits::nothing_to_do * goal) return false;
  struct Step {
    Vector direction, image;
    double energy;
  };
  std::deque<Step> steps;  // the last ones: rounding spoils the orthogonality that two would have
  for (int step = 0; step < Limits::most_unconstrained && !programme_.hessian.exhausted(); ++step) {
    precondition(active_set, residual, direction);
    active_set.project(direction);
    for (const auto& before : steps) direction.update(-before.image.dot(direction) / before.energy, before.direction, 1);
    programme_.hessian.apply(direction, product);
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
  for (auto& step : steps) recycle(active_set, std::move(step.direction), std::move(step.image), true);
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
  if (direction.norm2() > least_recycled * z.norm2())
    recycle(active_set, Vector(direction, Teuchos::Copy), Vector(product, Teuchos::Copy), false);
  y.assign(z);
  gy.assign(g);
  Descent descent(active_set, programme_.equality.communicator(), preconditioner_ && preconditioner_->knows_curvature(), gy);
  const double start = descent.size();
  if (start <= Limits::nothing_to_do * goal) return false;
  goal = std::max(goal, Limits::inner_reduction * start);
  if (trusted) {
    std::vector<std::pair<const Vector*, const Vector*>> moves;
    Eigen::MatrixXd images(view(z).size(), static_cast<Eigen::Index>(recycled_directions_.size()));
    for (auto pair = recycled_directions_.rbegin(); pair != recycled_directions_.rend(); ++pair) {
      images.col(static_cast<Eigen::Index>(moves.size())) =
          view(projected_image(active_set, pair->direction, pair->product, weight, 1));
      moves.emplace_back(&pair->direction, &pair->product);
    }
    descent.go(moves, std::move(images), least_new);
  }
  std::deque<std::pair<Vector, Vector>> fresh;
  const int most = static_cast<int>(std::max(Limits::fewest_inner, kept_));
  for (int step = 0; step < most && descent.size() > goal && !programme_.hessian.exhausted(); ++step) {
    const Vector free = descent.split(constrained);
    constrained.scale(1 / weight);
    precondition(active_set, free, direction);
    if (active_set.coupled()) active_set.project(direction);  // else the next projection is the same
    active_set.project_trial(direction, constrained);
    programme_.hessian.apply(direction, product);
    const auto& [d, p] = fresh.emplace_back(Vector(direction, Teuchos::Copy), Vector(product, Teuchos::Copy));
    if (!descent.go(d, p, projected_image(active_set, d, p, weight, 2), 0)) break;
    report();
  }
  descent.finish(y, gy);
  for (auto& [d, p] : fresh) recycle(active_set, std::move(d), std::move(p), true);
  return true;
}

}  // namespace mortise::qp
