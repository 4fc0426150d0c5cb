#include "rows/moments.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "base/dense.hpp"

namespace mortise::contact {

namespace {

// All of the nodes' spread. Farther apart than that, a lever is no correction of facets any more: its coefficients would be
// larger than the row's own. Nodes in a line pass on no moment across it.
constexpr double longest = 1, in_line = 0.1;
// Of the distances of the nodes: less is rounding, and nodes of which one has nearly all do not spread, nor do those of a bond in
// a plane model across the line that they lie on, along which its row acts where supports hold what is across.
constexpr double no_moment = 1e-11, no_spread = 1e-4;
constexpr double no_gap = 1e-3;  // what is less is what smooth surfaces through the nodes are wrong by

// Minus the sum of coefficients times places.
Point resultant(std::span<const Term> terms, double d, const Side& side)
{
  Point result = Point::Zero();
  for (const auto& term : terms) result -= term.value / d * side.points[static_cast<std::size_t>(term.node)];
  return result;
}

void add(const Eigen::VectorXd& change, double d, std::span<Term> terms)
{
  for (Eigen::Index k = 0; k < change.size(); ++k) terms[static_cast<std::size_t>(k)].value += d * change[k];
}

}  // namespace

Eigen::Matrix<double, 3, 2> tangent_plane(const Point& normal, int dimension)
{
  Eigen::Matrix<double, 3, 2> axes = Eigen::Matrix<double, 3, 2>::Zero();
  if (dimension == 2) {
    axes.col(0) = Point(-normal[1], normal[0], 0);
  } else {
    axes.col(0) = normal.unitOrthogonal();
    axes.col(1) = normal.cross(Point(axes.col(0)));
  }
  return axes;
}

Spread::Spread(std::span<const Term> terms, double d, const Side& side, const Eigen::Matrix<double, 3, 2>& axes)
{
  const auto count = static_cast<Eigen::Index>(terms.size());
  if (count < 2) return;
  const auto at = [&](std::size_t k) -> const Point& { return side.points[static_cast<std::size_t>(terms[k].node)]; };
  for (std::size_t k = 1; k < terms.size(); ++k) distance_ = std::max(distance_, (at(k) - at(0)).norm());
  size_.resize(count);
  place_.resize(2, count);
  for (Eigen::Index k = 0; k < count; ++k) {
    size_[k] = std::abs(terms[static_cast<std::size_t>(k)].value) / d;
    place_.col(k) = axes.transpose() * at(static_cast<std::size_t>(k));
  }
  const Eigen::Vector2d mean = place_ * size_ / size_.sum();
  place_.colwise() -= mean;
  const auto spread = dense::plane_eigenpairs(place_ * size_.asDiagonal() * place_.transpose() / size_.sum());
  directions_ = spread.vectors;
  lengths_ = spread.values.cwiseMax(0).cwiseSqrt();
}

Eigen::VectorXd Spread::least(const Eigen::Vector2d& moment) const
{
  if (size_.size() == 0) return {};
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();
  for (int k = 0; k < 2; ++k) {
    const double part = directions_.col(k).dot(moment), length = lengths_[k];
    if (length < std::max(in_line * lengths_[1], no_spread * distance_) || std::abs(part) > longest * length) continue;
    if (std::abs(part) < no_moment * extent()) continue;
    slope += part / (length * length * size_.sum()) * directions_.col(k);
  }
  if (slope.isZero(0)) return {};
  return size_.cwiseProduct(place_.transpose() * slope);
}

Point Moments::across(double gap, const Point& normal, const Point& own_normal)
{
  constexpr double least = 0.5;  // cosine: beyond, neither is known
  const double cosine = own_normal.dot(normal);
  return cosine > least ? Point(gap / cosine * own_normal) : Point(gap * normal);
}

Moments::Moments(std::span<Term> terms, double d, const Point& normal, const Point& closing, const Point* at,
                 const Side& secondary, const Side& primary, int dimension)
    : axes_(tangent_plane(normal, dimension))
{
  const auto middle = std::find_if(terms.begin(), terms.end(), [](const Term& term) { return term.on_primary; });
  const std::span own(terms.begin(), middle), other(middle, terms.end());
  if (at) {
    double weight = 0;
    for (const auto& term : own) weight += term.value / d;
    add(Spread(own, d, secondary, axes_).least(axes_.transpose() * (weight * *at + resultant(own, d, secondary))), d, own);
  }
  Point apart = resultant(own, d, secondary) + resultant(other, d, primary);  // s
  if (other.size() < 2) return;
  for (const auto& term : other) nodes_.push_back(term.node);
  spread_ = Spread(other, d, primary, axes_);
  if (std::abs(closing.dot(normal)) > no_gap * spread_.extent()) apart -= closing;
  offset_ = apart.dot(normal);
  const Eigen::VectorXd change = spread_.least(axes_.transpose() * apart);
  add(change, d, other);
  for (Eigen::Index k = 0; k < change.size(); ++k)  // they lie on no plane
    offset_ -= change[k] * primary.points[static_cast<std::size_t>(other[static_cast<std::size_t>(k)].node)].dot(normal);
}

std::vector<Term> Moments::couple(const Point& tangent) const
{
  std::vector<Term> result;
  const Eigen::VectorXd values = spread_.least(-offset_ * (axes_.transpose() * tangent));
  for (Eigen::Index k = 0; k < values.size(); ++k) result.push_back({nodes_[static_cast<std::size_t>(k)], true, values[k]});
  return result;
}

}  // namespace mortise::contact
