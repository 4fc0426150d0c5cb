#include "moments.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace mortise::contact {

namespace {

// All of the nodes' spread. Farther apart than that, a lever is no correction of facets any more: its coefficients would be
// larger than the row's own. Nodes in a line pass on no moment across it.
constexpr double longest = 1, in_line = 0.1;
// Of the distances of the nodes: less is rounding, and nodes of which one has nearly all do not spread.
constexpr double no_moment = 1e-11, no_spread = 1e-4;
constexpr double no_gap = 1e-3;  // what is less is what smooth surfaces through the nodes are wrong by

}  // namespace

Moments::Moments(std::span<Term> terms, double d, const Point& normal, double gap, const Side& secondary, const Side& primary,
                 int dimension)
{
  if (dimension == 2)
    axes_.col(0) = Point(-normal[1], normal[0], 0);
  else {
    axes_.col(0) = normal.unitOrthogonal();
    axes_.col(1) = normal.cross(Point(axes_.col(0)));
  }
  Point apart = Point::Zero();  // s
  std::vector<std::size_t> mine;
  for (std::size_t i = 0; i < terms.size(); ++i) {
    const auto& term = terms[i];
    const Side& side = term.on_primary ? primary : secondary;
    apart -= term.value / d * side.points[static_cast<std::size_t>(term.node)];
    if (term.on_primary) mine.push_back(i);
  }
  const auto count = static_cast<Eigen::Index>(mine.size());
  if (count < 2) return;
  size_.resize(count);
  place_.resize(2, count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const auto& term = terms[mine[static_cast<std::size_t>(k)]];
    nodes_.push_back(term.node);
    size_[k] = std::abs(term.value) / d;
    place_.col(k) = axes_.transpose() * primary.points[static_cast<std::size_t>(term.node)];
  }
  const Eigen::Vector2d mean = place_ * size_ / size_.sum();
  place_.colwise() -= mean;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> spread(place_ * size_.asDiagonal() * place_.transpose() / size_.sum());
  directions_ = spread.eigenvectors();
  lengths_ = spread.eigenvalues().cwiseMax(0).cwiseSqrt();
  offset_ = apart.dot(normal) - (std::abs(gap) > no_gap * place_.colwise().norm().maxCoeff() ? gap : 0.0);
  const Eigen::VectorXd change = least(axes_.transpose() * apart);
  for (Eigen::Index k = 0; k < change.size(); ++k) {
    auto& term = terms[mine[static_cast<std::size_t>(k)]];
    term.value += d * change[k];
    offset_ -= change[k] * primary.points[static_cast<std::size_t>(term.node)].dot(normal);  // they lie on no plane
  }
}

Eigen::VectorXd Moments::least(const Eigen::Vector2d& moment) const
{
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();
  const double extent = place_.colwise().norm().maxCoeff();
  for (int k = 0; k < 2; ++k) {
    const double part = directions_.col(k).dot(moment), length = lengths_[k];
    if (length < std::max(in_line * lengths_[1], no_spread * extent) || std::abs(part) > longest * length) continue;
    if (std::abs(part) < no_moment * extent) continue;
    slope += part / (length * length * size_.sum()) * directions_.col(k);
  }
  if (slope.isZero(0)) return {};
  return size_.cwiseProduct(place_.transpose() * slope);
}

std::vector<Term> Moments::couple(const Point& tangent) const
{
  std::vector<Term> result;
  if (nodes_.empty()) return result;
  const Eigen::VectorXd values = least(-offset_ * (axes_.transpose() * tangent));
  for (Eigen::Index k = 0; k < values.size(); ++k) result.push_back({nodes_[static_cast<std::size_t>(k)], true, values[k]});
  return result;
}

}  // namespace mortise::contact
