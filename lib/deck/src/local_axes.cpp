#include "deck/local_axes.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "deck/cases.hpp"
#include "deck/document.hpp"

namespace mortise::deck {

namespace {

Point vector(const std::array<double, 3>& v)
{
  return {v[0], v[1], v[2]};
}

constexpr double on_the_axis = 1e-9;  // of the distance from its point
constexpr double parallel = 1e-6;     // sine of the angle below which two directions are one
constexpr double the_same = 1e-9;     // of unit vectors, and of sizes

}  // namespace

void describe(Description<AxesOptions>& d)
{
  d.help("Local axes, that supports and loads refer to: cylindrical about `axis`, or rotated, with `x` and `y`.");
  d.key("axis", &AxesOptions::axis, "Cylindrical: the direction of the axis; components are radial, tangential and axial.");
  d.key("point", &AxesOptions::point, "A point of the axis.");
  d.key("x", &AxesOptions::x, "Rotated: the direction of the first axis.");
  d.key("y", &AxesOptions::y, "The direction of the second axis, made orthogonal to the first (plane models: not needed).");
  d.rule(one_given({"axis", "x"}));
  d.rule(when(given({"y"}), given({"x"})));
  d.check([](const AxesOptions& axes, const std::string& path, Document& document) {
    if (axes.axis.has_value() == axes.x.has_value())
      document.error(path, "expected either an `axis`, for cylindrical components, or `x`, for rotated axes");
    if (axes.y && !axes.x) document.error(path + ".y", "rotated axes have an `x`, too");
    if (axes.axis && !(vector(*axes.axis).norm() > 0)) document.error(path + ".axis", "expected a direction, found zeros");
    if (axes.x && !(vector(*axes.x).norm() > 0)) document.error(path + ".x", "expected a direction, found zeros");
    if (axes.x && axes.y &&
        !(vector(*axes.x).cross(vector(*axes.y)).norm() > parallel * vector(*axes.x).norm() * vector(*axes.y).norm()))
      document.error(path + ".y", "expected a direction other than that of `x`");
  });
}

LocalAxes::LocalAxes(const AxesOptions& options, bool planar)
    : cylindrical_(options.axis.has_value()), point_(vector(options.point))
{
  if (cylindrical_) {
    axes_.setZero();
    axes_.row(2) = vector(*options.axis).normalized().transpose();
    return;
  }
  const Point first = vector(*options.x).normalized();
  Point second = planar ? Point(-first[1], first[0], 0) : vector(options.y.value());
  second = (second - first.dot(second) * first).normalized();
  axes_.row(0) = first.transpose();
  axes_.row(1) = second.transpose();
  axes_.row(2) = first.cross(second).transpose();
}

std::optional<Eigen::Matrix3d> LocalAxes::at(const Point& place, double rounding) const
{
  if (!cylindrical_) return axes_;
  const Point along = axis(), from = place - point_;
  const Point radius = from - along.dot(from) * along;
  if (!(radius.norm() > rounding)) return {};
  Eigen::Matrix3d result = axes_;
  result.row(0) = radius.normalized().transpose();
  result.row(1) = along.cross(Point(radius.normalized())).transpose();
  return result;
}

Eigen::Matrix3d LocalAxes::everywhere(const Point& place) const
{
  if (const auto found = at(place, on_the_axis * (place - point_).norm())) return *found;
  const Point along = axis();
  Eigen::Index least = 0;
  along.cwiseAbs().minCoeff(&least);
  return *at(point_ + along.cross(Point::Unit(least)));
}

LocalAxes LocalAxes::moved(const Eigen::Matrix3d& rotation, const Point& translation) const
{
  LocalAxes result(*this);
  result.point_ = rotation * point_ + translation;
  result.axes_ = axes_ * rotation.transpose();
  return result;
}

bool LocalAxes::coincides(const LocalAxes& other, double size) const
{
  if (cylindrical_ != other.cylindrical_ || (axes_ - other.axes_).norm() > the_same) return false;
  return !cylindrical_ || axis().cross(Point(point_ - other.point_)).norm() <= the_same * size;
}

}  // namespace mortise::deck
