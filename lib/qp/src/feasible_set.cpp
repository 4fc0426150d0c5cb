#include "qp/feasible_set.hpp"

#include <cassert>
#include <cmath>
#include <map>

namespace mortise::qp {

namespace {

// A point within this relative distance of the circle counts as on it: projections land there up to rounding.
constexpr double on_circle = 1 - 1e-12;

bool on_boundary(const Disc& disc, const Eigen::Vector2d& y)
{
  return y.squaredNorm() >= disc.radius * disc.radius * on_circle * on_circle;
}

Eigen::Vector2d gather(const Disc& disc, const Eigen::Ref<const Eigen::VectorXd>& v)
{
  return {v[disc.index[0]], disc.index[1] < 0 ? 0.0 : v[disc.index[1]]};
}

void scatter(const Disc& disc, const Eigen::Vector2d& value, Eigen::Ref<Eigen::VectorXd> v)
{
  v[disc.index[0]] = value[0];
  if (disc.index[1] >= 0) v[disc.index[1]] = value[1];
}

Eigen::Vector2d centre(const Disc& disc)
{
  return {disc.centre[0], disc.centre[1]};
}

// Largest a with ||y - a p|| <= radius for ||y|| <= radius, written without cancellation.
double step_in_disc(const Eigen::Vector2d& y, const Eigen::Vector2d& p, double radius)
{
  const double a = p.squaredNorm();
  if (a == 0 || std::isinf(radius)) return std::numeric_limits<double>::infinity();
  const double b = y.dot(p);
  const double c = std::max(radius * radius - y.squaredNorm(), 0.0);
  const double root = std::sqrt(b * b + a * c);
  if (b >= 0) return (b + root) / a;
  return c == 0 ? 0 : c / (root - b);
}

}  // namespace

Eigen::Vector2d from_centre(const Disc& disc, const Eigen::Ref<const Eigen::VectorXd>& x)
{
  return gather(disc, x) - centre(disc);
}

std::vector<double> FeasibleSet::radii() const
{
  std::vector<double> result;
  for (const auto& disc : discs_) result.push_back(disc.radius);
  return result;
}

FeasibleSet FeasibleSet::with_radii(std::span<const double> radii) const
{
  FeasibleSet result = *this;
  result.set_radii(radii);
  return result;
}

void FeasibleSet::set_radii(std::span<const double> radii)
{
  assert(radii.size() == discs_.size());
  for (std::size_t i = 0; i < discs_.size(); ++i) discs_[i].radius = radii[i];
}

std::vector<Local> FeasibleSet::constrained() const
{
  std::vector<Local> unknowns;
  for (const auto& bound : bounds_) unknowns.push_back(bound.index);
  for (const auto& disc : discs_) unknowns.insert(unknowns.end(), disc.index.begin(), disc.index.begin() + disc.size());
  return unknowns;
}

FeasibleSet FeasibleSet::compact() const
{
  FeasibleSet result = *this;
  Local next = 0;
  std::map<Local, Local> place;
  for (auto& bound : result.bounds_) bound.index = place[bound.index] = next++;
  for (auto& disc : result.discs_) {
    for (int c = 0; c < disc.size(); ++c) disc.index[static_cast<std::size_t>(c)] = next++;
    const auto normal = place.find(disc.normal);
    disc.normal = normal == place.end() ? -1 : normal->second;
  }
  return result;
}

void FeasibleSet::set_coefficients(std::span<const double> coefficients)
{
  assert(coefficients.size() == discs_.size());
  for (std::size_t i = 0; i < discs_.size(); ++i) discs_[i].coefficient = coefficients[i];
}

FeasibleSet FeasibleSet::with_cones() const
{
  FeasibleSet result = *this;
  result.cones_ = true;
  return result;
}

FeasibleSet FeasibleSet::shifted(const Eigen::Ref<const Eigen::VectorXd>& shift) const
{
  FeasibleSet result = *this;
  for (auto& bound : result.bounds_) bound.lower -= shift[bound.index];
  for (auto& disc : result.discs_)
    for (int k = 0; k < disc.size(); ++k) disc.centre[k] -= shift[disc.index[k]];
  return result;
}

void FeasibleSet::project(Eigen::Ref<Eigen::VectorXd> x) const
{
  if (cones_)  // before the bounds, which would move their normal unknowns
    for (const auto& disc : discs_) {
      if (!is_cone(disc)) continue;
      const Eigen::Vector2d tangential = gather(disc, x);
      const double t = tangential.norm(), n = x[disc.normal], mu = disc.coefficient;
      if (t <= mu * n) continue;
      const double pressed = std::max((n + mu * t) / (1 + mu * mu), 0.0);
      x[disc.normal] = pressed;
      scatter(disc, t > 0 ? Eigen::Vector2d(tangential * (mu * pressed / t)) : tangential, x);
    }
  for (const auto& bound : bounds_) x[bound.index] = std::max(x[bound.index], bound.lower);
  for (const auto& disc : discs_) {
    if (is_cone(disc)) continue;
    const Eigen::Vector2d y = from_centre(disc, x);
    const double norm = y.norm();
    if (norm > disc.radius) scatter(disc, centre(disc) + y * (disc.radius / norm), x);
  }
}

void FeasibleSet::split(const Eigen::Ref<const Eigen::VectorXd>& x, const Eigen::Ref<const Eigen::VectorXd>& g,
                        Eigen::Ref<Eigen::VectorXd> free, Eigen::Ref<Eigen::VectorXd> chopped) const
{
  free = g;
  chopped.setZero();
  for (const auto& bound : bounds_) {
    if (x[bound.index] > bound.lower) continue;
    free[bound.index] = 0;
    chopped[bound.index] = std::min(g[bound.index], 0.0);
  }
  for (const auto& disc : discs_) {
    const Eigen::Vector2d y = from_centre(disc, x);
    if (disc.radius > 0 && !on_boundary(disc, y)) continue;
    scatter(disc, Eigen::Vector2d::Zero(), free);
    if (disc.radius == 0) continue;  // pinned: neither free nor chopped, or every step would have length 0
    const Eigen::Vector2d n = y.normalized();
    const Eigen::Vector2d gradient = gather(disc, g);
    scatter(disc, gradient - std::min(n.dot(gradient), 0.0) * n, chopped);
  }
}

double FeasibleSet::feasible_step(const Eigen::Ref<const Eigen::VectorXd>& x, const Eigen::Ref<const Eigen::VectorXd>& p) const
{
  double step = std::numeric_limits<double>::infinity();
  for (const auto& bound : bounds_)
    if (p[bound.index] > 0) step = std::min(step, (x[bound.index] - bound.lower) / p[bound.index]);
  for (const auto& disc : discs_)
    if (disc.radius > 0) step = std::min(step, step_in_disc(from_centre(disc, x), gather(disc, p), disc.radius));
  return std::max(step, 0.0);
}

FeasibleSet::Active FeasibleSet::active(const Eigen::Ref<const Eigen::VectorXd>& x) const
{
  Active count;
  for (const auto& bound : bounds_) count.bounds += x[bound.index] <= bound.lower;
  for (const auto& disc : discs_) count.discs += disc.radius > 0 && on_boundary(disc, from_centre(disc, x));
  return count;
}

}  // namespace mortise::qp
