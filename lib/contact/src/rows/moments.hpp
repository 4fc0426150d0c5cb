// Rows that pass a force on where it acts: the rotations of both sides together are no jump.
//
// A row pushes with its force f at x_s, the secondary nodes weighted with their coefficients, and with -f at x_p = sum m_j x_j on
// the primary side. Where facets of curved surfaces do not match, s = x_p - x_s is not 0: along the surface it is some part of
// the difference of two facets' sagittas, which makes a pressure turn the bodies; along the normal it is the sagitta itself,
// which takes a part of each torque that friction or a bond passes on [cf. Puso, IJNME 59 (2004): a tied mesh that keeps its
// angular momentum].
#pragma once

#include <span>
#include <vector>

#include "integrals/face_integrals.hpp"
#include "surface/side.hpp"

namespace mortise::contact {

/// Two directions orthogonal to a normal, in columns; in 2 dimensions the second is 0.
Eigen::Matrix<double, 3, 2> tangent_plane(const Point& normal, int dimension);

/// The nodes of one side that a row pushes on, in the tangent plane of its direction.
class Spread {
 public:
  Spread() = default;
  /// `axes`: of the tangent plane, in its columns. `terms`: those of one side.
  Spread(std::span<const Term> terms, double d, const Side& side, const Eigen::Matrix<double, 3, 2>& axes);

  /// Values c_j = w_j b.y_j, w_j the present sizes and y_j the places from their mean: their sum is 0, and sum c_j y_j is given.
  /// Empty if that is next to nothing, or the nodes lie too close together for it.
  Eigen::VectorXd least(const Eigen::Vector2d& moment) const;
  double extent() const { return place_.cols() > 0 ? place_.colwise().norm().maxCoeff() : 0.0; }

 private:
  double distance_ = 0;   // of nodes, the largest from the first one
  Eigen::VectorXd size_;  // of the coefficients
  Eigen::Matrix2Xd place_;
  Eigen::Matrix2d directions_ = Eigen::Matrix2d::Identity();  // in which they spread least and most,
  Eigen::Vector2d lengths_ = Eigen::Vector2d::Zero();         // and how far
};

/// The terms of one row, and what they lack.
class Moments {
 public:
  Moments() = default;
  /// Changes `terms` (merged, those of the secondary side first; sums of coefficients are kept) by the least, relative to their
  /// size: the secondary ones so that the row acts `at` that point, but along `normal`, if it is one other than their own; the
  /// primary ones so that s lies along `normal`: then neither side's rotations are felt by the normal row more than by the other.
  /// `dimension`: 2 or 3. `closing`: the part of s that closes before a force acts, as that of smooth surfaces which come to
  /// touch; it is across() the gap.
  Moments(std::span<Term> terms, double d, const Point& normal, const Point& closing, const Point* at, const Side& secondary,
          const Side& primary, int dimension);

  /// From a place to what is paired with it beyond a `gap` along the row's `normal`: integrals pair along the secondary side's
  /// own normal.
  static Point across(double gap, const Point& normal, const Point& own_normal);

  /// The couple along the normal on the primary nodes that makes up for s in a row along `tangent`: its coefficients sum to 0.
  /// Empty where there is none.
  std::vector<Term> couple(const Point& tangent) const;

 private:
  Eigen::Matrix<double, 3, 2> axes_ = Eigen::Matrix<double, 3, 2>::Zero();  // of the tangent plane
  std::vector<Local> nodes_;                                                // of the primary side
  Spread spread_;                                                           // of these
  double offset_ = 0;                                                       // s along the normal
};

}  // namespace mortise::contact
