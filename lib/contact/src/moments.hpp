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

#include "face_integrals.hpp"
#include "side.hpp"

namespace mortise::contact {

/// The primary terms of one row, and what they lack.
class Moments {
 public:
  /// Changes the primary ones of `terms` (sums of coefficients are kept) by the least, relative to their size, so that s lies
  /// along `normal`: then neither side's rotations are felt by the normal row more than by the other. `dimension`: 2 or 3. `gap`:
  /// the part of s along the normal that closes before a force acts, as that of smooth surfaces which come to touch.
  Moments(std::span<Term> terms, double d, const Point& normal, double gap, const Side& secondary, const Side& primary,
          int dimension);

  /// The couple along the normal on the primary nodes that makes up for s in a row along `tangent`: its coefficients sum to 0.
  /// Empty where there is none.
  std::vector<Term> couple(const Point& tangent) const;

 private:
  // Values c_j = w_j b.y_j, w_j the present sizes: their sum is 0, and sum c_j y_j is given. Empty if that is next to nothing.
  Eigen::VectorXd least(const Eigen::Vector2d& moment) const;

  Eigen::Matrix<double, 3, 2> axes_ = Eigen::Matrix<double, 3, 2>::Zero();  // of the tangent plane
  std::vector<Local> nodes_;                                                // of the primary side
  Eigen::VectorXd size_;                                                    // of their coefficients
  Eigen::Matrix2Xd place_;                                                  // y_j, in the tangent plane, from their weighted mean
  Eigen::Matrix2d directions_ = Eigen::Matrix2d::Identity();                // in which they spread least and most,
  Eigen::Vector2d lengths_ = Eigen::Vector2d::Zero();                       // and how far
  double offset_ = 0;                                                       // s along the normal
};

}  // namespace mortise::contact
