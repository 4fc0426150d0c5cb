#include "qp/projection.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

namespace mortise::qp {

namespace {

constexpr int max_steps = 1000;
constexpr int max_search = 60;        // of each line search
constexpr double flat = 0.1;          // part of its first slope at which a line search ends
constexpr double far = 0.25;          // part of a step below which it was much too long
constexpr double unbounded = 1e10;    // of ||G' nu|| over ||e|| and ||y||, at which C counts as empty
constexpr double target = 1e-13;      // of the residual
constexpr double acceptable = 1e-8;   // at which a projection that makes no more progress counts as found
constexpr double far_away = 1e6;      // times ||e|| and ||y||: larger points are none
constexpr int max_tries = 10;         // steps that do not halve it
constexpr double near_enough = 1e-9;  // at which fewer steps are tried
constexpr int max_stalled = 3;
constexpr int max_repairs = 5;  // with the residual e - G x taken from x itself

// What constraints may take away; `coupled`: of discs together with the unknown that their radius follows.
std::vector<BlockIndex> blocks_of(const FeasibleSet& set, bool coupled)
{
  std::vector<BlockIndex> blocks;
  for (const auto& bound : set.bounds()) blocks.push_back({bound.index, -1, -1});
  for (const auto& disc : set.discs()) blocks.push_back({disc.index[0], disc.index[1], coupled ? disc.normal : -1});
  return blocks;
}

SparseMatrix columns_of(const SparseMatrix& g, std::span<const Local> columns)
{
  std::vector<Eigen::Triplet<double>> triplets;
  for (std::size_t c = 0; c < columns.size(); ++c)
    for (SparseMatrix::InnerIterator it(g, columns[c]); it; ++it)
      triplets.emplace_back(static_cast<int>(it.row()), static_cast<int>(c), it.value());
  SparseMatrix result(g.rows(), static_cast<Eigen::Index>(columns.size()));
  result.setFromTriplets(triplets.begin(), triplets.end());
  return result;
}

// I - D of a cone at (t, n); nothing inside of it.
std::optional<DowndateBlock> downdate_of_cone(const Disc& disc, const Eigen::Vector2d& t, double n)
{
  const double length = t.norm(), mu = disc.coefficient;
  if (length <= mu * n) return {};
  DowndateBlock block;
  block.index = {disc.index[0], disc.index[1], disc.normal};
  block.matrix(0, 0) = block.matrix(2, 2) = 1;
  if (disc.size() == 2) block.matrix(1, 1) = 1;
  const double pressed = (n + mu * length) / (1 + mu * mu);
  if (pressed <= 0) return block;
  // D is the projector on the edge (n, t) = (1, mu) and, along the circle, mu pressed / length.
  const Eigen::Vector2d out = t / length, along(-out[1], out[0]);
  const Eigen::Vector3d edge = Eigen::Vector3d(mu * out[0], mu * out[1], 1) / std::sqrt(1 + mu * mu);
  block.matrix -= edge * edge.transpose();
  if (disc.size() == 2) block.matrix.topLeftCorner<2, 2>() -= mu * pressed / length * along * along.transpose();
  return block;
}

// I - D with the derivative D of the projection onto `set` at w, over its constrained unknowns.
std::vector<DowndateBlock> downdates(const FeasibleSet& set, const Eigen::VectorXd& w)
{
  std::vector<DowndateBlock> blocks;
  Local next = 0;                   // w is in the order of FeasibleSet::constrained()
  std::map<Local, double> pressed;  // of the normal unknowns of cones
  if (set.has_cones())
    for (const auto& disc : set.discs())
      if (set.is_cone(disc)) pressed[disc.normal] = 0;
  for (const auto& bound : set.bounds()) {
    const double value = w[next++];
    if (const auto found = pressed.find(bound.index); found != pressed.end()) {
      found->second = value;
      continue;
    }
    if (value > bound.lower) continue;
    auto& block = blocks.emplace_back();
    block.index[0] = bound.index;
    block.matrix(0, 0) = 1;
  }
  for (const auto& disc : set.discs()) {
    const Eigen::Vector2d y(w[next] - disc.centre[0], disc.size() == 2 ? w[next + 1] - disc.centre[1] : 0.0);
    next += disc.size();
    const double distance = y.norm();
    if (set.is_cone(disc)) {
      if (auto block = downdate_of_cone(disc, y, pressed.at(disc.normal))) blocks.push_back(*block);
      continue;
    }
    if (distance <= disc.radius) continue;
    const Eigen::Vector2d n = y / distance;
    auto& block = blocks.emplace_back();
    block.index = {disc.index[0], disc.index[1], -1};
    if (disc.size() == 1)
      block.matrix(0, 0) = 1;
    else
      block.matrix.topLeftCorner<2, 2>() =
          Eigen::Matrix2d::Identity() - disc.radius / distance * (Eigen::Matrix2d::Identity() - n * n.transpose());
  }
  return blocks;
}

// Whether x balances every row of G x = e to what its own forces are rounded by: a body that hangs on soft springs is moved far
// by what is little beside the forces on others. Collective.
bool balances_rows(const EqualityConstraint& equality, const Eigen::VectorXd& e, const Vector& x, const Eigen::VectorXd& missing)
{
  Eigen::VectorXd forces = equality.local().cwiseAbs() * view(x).cwiseAbs();
  equality.communicator().sum_in_place({forces.data(), static_cast<std::size_t>(forces.size())});
  return (missing.array().abs() <= target * (forces + e.cwiseAbs()).array()).all();
}

}  // namespace

// The gradient of the dual function at one nu; vectors over the constrained unknowns.
struct Projector::Evaluation {
  Eigen::VectorXd nu;
  Eigen::VectorXd w;  // y - G' nu
  Eigen::VectorXd gradient;
  double multiplier_size = 0;  // ||G' nu||
};

// What is projected, and onto what.
struct Projector::Given {
  const Eigen::VectorXd& e;
  const FeasibleSet& set;
  Eigen::VectorXd constrained, gy;  // y over the constrained unknowns, and G y
  double scale;                     // ||e|| + ||y||, which residuals are relative to
  FeasibleSet compact = set.compact();
};

Projector::Projector(const EqualityConstraint& equality, const FeasibleSet& set)
    : equality_(equality),
      constrained_(set.constrained()),
      columns_(columns_of(equality.local(), constrained_)),
      matrix_(equality, blocks_of(set, set.has_cones())),
      trial_matrix_([this, blocks = blocks_of(set, true)] { return CoarseMatrix(equality_, blocks); })
{
}

Projector::Evaluation Projector::evaluate(const Given& y, Eigen::VectorXd nu) const
{
  Evaluation result;
  result.w = y.constrained - columns_.transpose() * nu;
  Eigen::VectorXd moved = result.w;  // P_Omega(w) - w
  y.compact.project(moved);
  moved -= result.w;
  Eigen::VectorXd sums = columns_ * moved;
  equality_.communicator().sum_in_place({sums.data(), static_cast<std::size_t>(sums.size())});
  const Eigen::VectorXd gram_nu = equality_.gram().selfadjointView<Eigen::Lower>() * nu;
  const Eigen::VectorXd missing = y.e - y.gy;
  result.gradient = missing + gram_nu - sums;
  result.multiplier_size = std::sqrt(std::max(nu.dot(gram_nu), 0.0));
  result.nu = std::move(nu);
  return result;
}

// The step from `now` along `direction`, of which `full` is the end, at which the slope of theta has nearly vanished. theta is
// convex: its slope rises, piecewise linearly, from below 0, and is known more exactly than theta. Each trial sums one number
// over the ranks.
double Projector::search(const Evaluation& now, const Evaluation& full, const Eigen::VectorXd& direction,
                         const FeasibleSet& compact) const
{
  const double slope = now.gradient.dot(direction), end = full.gradient.dot(direction);
  if (end < 0 || end <= flat * std::abs(slope)) return 1;
  // gradient(t) = gradient(0) + t G G' direction - G (moved(t) - moved(0)), moved = P_Omega(w) - w.
  const Eigen::VectorXd along = -(columns_.transpose() * direction);
  const double curvature = direction.dot(equality_.gram().selfadjointView<Eigen::Lower>() * direction);
  const auto moved_along = [&](const Eigen::VectorXd& w) {
    Eigen::VectorXd moved = w;
    compact.project(moved);
    moved -= w;
    return moved.dot(along);
  };
  const double start = moved_along(now.w);
  double low = 0, high = 1, slope_low = slope, slope_high = end, t = 1;
  for (int trial = 0; trial < max_search; ++trial) {
    // Secant and bisection in turn: the slope is flat as long as no constraint changes, and steep beyond.
    t = trial % 2 == 0 ? low - slope_low * (high - low) / (slope_high - slope_low) : 0.5 * (low + high);
    const double here = slope + t * curvature + equality_.communicator().sum(moved_along(now.w + t * along) - start);
    if (std::abs(here) <= flat * std::abs(slope)) break;
    (here < 0 ? low : high) = t;
    (here < 0 ? slope_low : slope_high) = here;
  }
  return t;
}

// Two figures that tell what points of C must at least be long: with w = -G'nu, -e'nu = w'x <= sum of radius |w| over the discs
// + ||v|| ||x|| for every x of C, v the part of w that points into Omega for ever. -e'nu less that sum, and ||v||.
std::pair<double, double> Projector::work_and_feeling(const Eigen::VectorXd& e, const FeasibleSet& set, const Eigen::VectorXd& nu,
                                                      const Vector& like) const
{
  Vector w(like.getMap());
  equality_.add_transpose(-1, nu, w);
  auto values = view(w);
  double in_discs = 0;
  for (const auto& disc : set.discs()) {
    if (set.is_cone(disc) || std::isinf(disc.radius)) continue;
    double square = 0;
    for (int k = 0; k < disc.size(); ++k)
      square += std::pow(std::exchange(values[disc.index[static_cast<std::size_t>(k)]], 0.0), 2);
    in_discs += disc.radius * std::sqrt(square);
  }
  std::vector<Disc> cones;
  for (const auto& disc : set.discs())
    if (set.is_cone(disc)) cones.push_back(disc);
  std::vector<Bound> bounds(set.bounds().begin(), set.bounds().end());
  for (auto& bound : bounds) bound.lower = 0;
  const FeasibleSet directions(std::move(bounds), std::move(cones));
  (set.has_cones() ? directions.with_cones() : directions).project(values);
  return {-e.dot(nu) - equality_.communicator().sum(in_discs), w.norm2()};
}

// Minimises theta from `nu` on; the multiplier with the smallest gradient, or one that has grown beyond all bounds.
Projector::Evaluation Projector::minimise(const Given& y, Eigen::VectorXd nu)
{
  const auto size_of = [&](const Evaluation& at) { return equality_.norm(at.gradient) / y.scale; };
  Evaluation now = evaluate(y, std::move(nu)), best = now;
  double least = size_of(now), residual = least, regularisation = 1e-1;
  int stalled = 0;
  for (int step = 0; step < max_steps && least > target && now.multiplier_size < unbounded * y.scale; ++step) {
    const auto factor =
        matrix_.factorize(downdates(y.set, now.w), std::clamp(regularisation * std::min(residual, 1.0), 1e-14, 1.0));
    if (!factor) {
      regularisation *= 10;
      continue;
    }
    const Eigen::VectorXd direction = -factor->solve(now.gradient);
    Evaluation next = evaluate(y, now.nu + direction);
    double t = 1;
    if (size_of(next) > 0.5 * residual) {
      t = search(now, next, direction, y.compact);
      if (t != 1) next = evaluate(y, now.nu + t * direction);
    }
    const double before = std::exchange(residual, size_of(next));
    // A residual that does not fall while full steps are taken wants larger steps.
    if (t == 1 && residual > 0.5 * before) regularisation *= 0.1;
    // Where hardly any of the step can be taken, some body went much too far; the others must not wait for it.
    if (t < far) regularisation *= 10;
    now = std::move(next);
    // Bodies that touch without force drift about at rounding level, and what they meet undoes what was gained; a ring between
    // rollers turns far before a trace of a moment finds its balance.
    stalled = residual < 0.5 * least ? 0 : stalled + 1;
    if (residual < least) {
      least = residual;
      best = now;
    }
    if (stalled > (least <= near_enough ? max_stalled : max_tries) && least <= acceptable) break;
  }
  return now.multiplier_size < unbounded * y.scale ? best : now;
}

// The point of `now`, improved by what its own residual says: G G' nu - G (P(w) - w), which the minimisation goes by, loses,
// where stiffnesses differ by 1e6, what the kernels of soft bodies need; G P(w) does not. Sets nu, the residual and the point.
void Projector::repair(const Vector& from, const Given& y, Evaluation now, Projection& result)
{
  result.nu = now.nu;
  for (int repair = 0; repair <= max_repairs; ++repair) {
    result.argument.assign(from);
    equality_.add_transpose(-1, now.nu, result.argument);
    Vector point(result.argument, Teuchos::Copy);
    y.set.project(view(point));
    const Eigen::VectorXd missing = y.e - equality_.apply(point);
    const double residual = equality_.norm(missing) / y.scale;
    if (repair > 0 && !(residual < result.residual)) break;
    result.nu = now.nu;
    result.residual = residual;
    result.point.assign(point);
    if (residual <= 1e2 * target && (residual == 0 || balances_rows(equality_, y.e, point, missing))) break;
    if (now.multiplier_size >= unbounded * y.scale) break;
    Eigen::VectorXd w = view(result.argument)(constrained_);
    const auto factor = matrix_.factorize(downdates(y.set, w), 1e-14);
    if (!factor) break;
    now.nu -= factor->solve(missing);
  }
}

// The nu that minimises theta(nu), of y = 0, + epsilon / 2 nu'D nu, D the diagonal of G G' where constraints touch G, for an
// epsilon that becomes small. It always exists, and epsilon D nu tends to the negative of the least r = e - G x, in the norm of
// D^-1, of all x in Omega: if that is not 0, nu proves that C is empty [Farkas].
Eigen::VectorXd Projector::towards_least_residual(const Eigen::VectorXd& e, const FeasibleSet& set)
{
  constexpr double first = 1e-2, factor = 1e-2, last = 1e-10, solved = 1e-10;
  constexpr int steps = 50, halvings = 10;
  Eigen::VectorXd metric = columns_.cwiseAbs() * Eigen::VectorXd::Ones(columns_.cols());
  equality_.communicator().sum_in_place({metric.data(), static_cast<std::size_t>(metric.size())});
  metric = (metric.array() > 0).select(Eigen::VectorXd(equality_.gram().diagonal()), 0.0);
  const Given nothing{e, set, Eigen::VectorXd::Zero(columns_.cols()), Eigen::VectorXd::Zero(equality_.size()), 0};
  const double small = solved * equality_.norm(e);
  Eigen::VectorXd nu = nothing.gy;
  for (double epsilon = first; epsilon >= last; epsilon *= factor) {
    const auto gradient = [&](const Evaluation& at) {
      return Eigen::VectorXd(at.gradient + epsilon * metric.cwiseProduct(at.nu));
    };
    Evaluation now = evaluate(nothing, nu);
    for (int step = 0; step < steps && equality_.norm(gradient(now)) > small; ++step) {
      const auto inverse = matrix_.factorize(downdates(set, now.w), epsilon);
      if (!inverse) return nu;
      const Eigen::VectorXd direction = -inverse->solve(gradient(now));
      const double slope = gradient(now).dot(direction);
      double t = 1;
      Evaluation next = evaluate(nothing, now.nu + direction);
      for (int halving = 0; halving < halvings && gradient(next).dot(direction) > flat * std::abs(slope); ++halving)
        next = evaluate(nothing, now.nu + (t /= 2) * direction);
      now = std::move(next);
    }
    nu = now.nu;
  }
  return nu;
}

bool Projector::prove_empty(const Eigen::VectorXd& e, const FeasibleSet& set, Projection& failed)
{
  constexpr double hardly = 1e-3, regularisation = 1e-12;
  constexpr double rounding_of_rows = 1e-10;  // what exact contact rows feel of motions along them
  constexpr int iterations = 3;
  const auto& comm = equality_.communicator();
  const double size = equality_.norm(e);
  for (Eigen::VectorXd nu : {towards_least_residual(e, set), failed.nu}) {
    // Near a proof only: what w = -G' nu hardly feels is made 0, by inverse iteration with the matrix of the rest.
    Eigen::VectorXd w = -(columns_.transpose() * nu);
    const double largest = comm.max(w.size() > 0 ? w.cwiseAbs().maxCoeff() : 0.0);
    w = (w.array().abs() < hardly * largest).select(0.0, w) * (unbounded * size / std::max(largest, 1e-300));
    for (auto& value : w)
      if (value == 0) value = std::numeric_limits<double>::min();  // of a bound at 0: kept
    const auto factor = matrix_.factorize(downdates(set, w), regularisation);
    if (!factor) continue;
    for (int i = 0; i < iterations; ++i) {
      nu = factor->solve(equality_.gram().selfadjointView<Eigen::Lower>() * nu);
      nu /= std::sqrt(std::max(nu.dot(equality_.gram().selfadjointView<Eigen::Lower>() * nu), 1e-300));
    }
    const auto [gained, felt] = work_and_feeling(e, set, nu, failed.point);
    if (!(gained > acceptable * size) || !(felt < rounding_of_rows)) continue;
    failed.nu = std::move(nu);
    failed.empty = true;
    return true;
  }
  return false;
}

Projection Projector::operator()(const Vector& from, const Eigen::VectorXd& e, const FeasibleSet& set,
                                 const Eigen::VectorXd& start)
{
  Projection result{Vector(from, Teuchos::Copy), Vector(from, Teuchos::Copy), Eigen::VectorXd::Zero(equality_.size())};
  if (equality_.size() == 0) {
    set.project(view(result.point));
    result.found = true;
    return result;
  }
  const Given y{e, set, view(from)(constrained_), equality_.apply(from), equality_.norm(e) + from.norm2() + 1e-300};
  repair(from, y, minimise(y, start.size() == equality_.size() ? start : result.nu), result);
  result.argument.assign(from);
  equality_.add_transpose(-1, result.nu, result.argument);
  result.found = result.residual <= acceptable;
  if (result.found) return result;
  const auto [gained, felt] = work_and_feeling(e, set, result.nu, from);
  result.empty = gained > 0 && gained / std::max(felt, std::numeric_limits<double>::min()) > far_away * y.scale;
  return result;
}

Projection project(const Vector& y, const EqualityConstraint& equality, const Eigen::VectorXd& e, const FeasibleSet& set)
{
  return Projector(equality, set)(y, e, set);
}

}  // namespace mortise::qp
