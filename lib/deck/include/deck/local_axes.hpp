// Axes that are not those of the model: cylindrical about an axis, or rotated.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "base/types.hpp"
#include "deck/description.hpp"

namespace mortise::deck {

/// An entry of the deck's section `axes`: either an `axis`, or `x` and where wanted `y`.
struct AxesOptions {
  std::optional<std::array<double, 3>> axis;  ///< cylindrical, about this direction through `point`
  std::array<double, 3> point{0, 0, 0};
  std::optional<std::array<double, 3>> x;  ///< rotated: the direction of the first axis
  std::optional<std::array<double, 3>> y;  ///< and, less its part along x, of the second one
};

/// The keywords.
void describe(Description<AxesOptions>& d);

/// Unit vectors by place.
class LocalAxes {
 public:
  /// Those of the model.
  LocalAxes() : cylindrical_(false), point_(Point::Zero()), axes_(Eigen::Matrix3d::Identity()) {}
  /// `planar`: in the plane z = 0, where a rotated `x` alone gives both axes.
  LocalAxes(const AxesOptions& options, bool planar);

  /// The axes at a place, in rows: radial (away from the axis), tangential, axial; or x, y, z. None where the axis is nearer than
  /// `rounding`, a length.
  std::optional<Eigen::Matrix3d> at(const Point& place, double rounding = 0) const;
  /// The same, and on the axis with some radial direction, one for all places there.
  Eigen::Matrix3d everywhere(const Point& place) const;
  bool cylindrical() const { return cylindrical_; }
  /// The axes of a body after the motion x -> rotation x + translation.
  LocalAxes moved(const Eigen::Matrix3d& rotation, const Point& translation) const;
  /// Whether both are the same to 1e-9, and the places of cylindrical axes to 1e-9 of `size`.
  bool coincides(const LocalAxes& other, double size) const;
  bool operator==(const LocalAxes& other) const
  {
    return cylindrical_ == other.cylindrical_ && point_ == other.point_ && axes_ == other.axes_;
  }
  /// The axis of cylindrical ones.
  Point axis() const { return axes_.row(2).transpose(); }

 private:
  bool cylindrical_;
  Point point_;
  Eigen::Matrix3d axes_;  // rows; of cylindrical ones the third is the axis
};

}  // namespace mortise::deck
