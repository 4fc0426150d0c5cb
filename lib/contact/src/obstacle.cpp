#include "contact/obstacle.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <optional>

namespace mortise::contact {

namespace {

using Vector3 = std::array<double, 3>;

struct PlaneOptions {
  Vector3 point{0, 0, 0}, normal{0, 0, 0};
};
struct CylinderOptions {
  Vector3 point{0, 0, 0}, axis{0, 0, 1};
  double radius = 0;
  bool inside = false;
};
struct SphereOptions {
  Vector3 center{0, 0, 0};
  double radius = 0;
  bool inside = false;
};

constexpr const char* hollow = "true: bodies are inside, in a hollow; false: the obstacle is solid.";

void describe(deck::Description<PlaneOptions>& d)
{
  d.help("A half space.");
  d.key("point", &PlaneOptions::point, "Any point of its surface.").required();
  d.key("normal", &PlaneOptions::normal, "Out of the obstacle, towards the bodies; of any length.").required();
  d.check([](const PlaneOptions& plane, const std::string& path, deck::Document& document) {
    if (plane.normal == Vector3{0, 0, 0}) document.error(path + ".normal", "expected a direction, found a zero vector");
  });
}

void describe(deck::Description<CylinderOptions>& d)
{
  d.help("A circular cylinder without ends; in plane models a circle.");
  d.key("point", &CylinderOptions::point, "Any point of its axis.").required();
  d.key("axis", &CylinderOptions::axis, "Direction of the axis, of any length; z if not given, as plane models need.");
  d.key("radius", &CylinderOptions::radius, "Its radius.").positive().required();
  d.key("inside", &CylinderOptions::inside, hollow);
  d.check([](const CylinderOptions& cylinder, const std::string& path, deck::Document& document) {
    if (cylinder.axis == Vector3{0, 0, 0}) document.error(path + ".axis", "expected a direction, found a zero vector");
  });
}

void describe(deck::Description<SphereOptions>& d)
{
  d.help("A sphere.");
  d.key("center", &SphereOptions::center, "Its centre.").required();
  d.key("radius", &SphereOptions::radius, "Its radius.").positive().required();
  d.key("inside", &SphereOptions::inside, hollow);
}

Point point(const Vector3& x)
{
  return {x[0], x[1], x[2]};
}
Vector3 array(const Point& x)
{
  return {x[0], x[1], x[2]};
}

template <class T>
std::optional<T> read_shape(const YAML::Node& node, const std::string& path, deck::Document& document)
{
  T options;
  const auto before = document.error_count();
  deck::Codec<T>::read(options, node, path, document, {});
  return document.error_count() == before ? std::optional(options) : std::nullopt;
}

}  // namespace

SignedDistance signed_distance(const Obstacle& obstacle, const Point& x)
{
  if (obstacle.shape == Obstacle::Shape::plane) return {obstacle.direction.dot(x - obstacle.point), obstacle.direction};
  Point out = x - obstacle.point;
  if (obstacle.shape == Obstacle::Shape::cylinder) out -= out.dot(obstacle.direction) * obstacle.direction;
  const double length = out.norm();
  if (!(length > 1e-9 * obstacle.radius)) return {};
  const double side = obstacle.inside ? -1 : 1;
  return {side * (length - obstacle.radius), side / length * out};
}

double distance_along(const Obstacle& obstacle, const Point& x, const Point& direction)
{
  constexpr double infinite = std::numeric_limits<double>::infinity();
  Point out = x - obstacle.point, along = direction;
  if (obstacle.shape == Obstacle::Shape::plane) {
    const double towards = -along.dot(obstacle.direction);
    return towards > 0 ? obstacle.direction.dot(out) / towards : infinite;
  }
  if (obstacle.shape == Obstacle::Shape::cylinder) {
    out -= out.dot(obstacle.direction) * obstacle.direction;
    along -= along.dot(obstacle.direction) * obstacle.direction;
  }
  // a t^2 + 2 b t + c = 0: the root where the line enters a solid obstacle, or leaves a hollow one.
  const double side = obstacle.inside ? -1 : 1, towards = -side * out.dot(along);
  const double a = along.squaredNorm(), c = (out.norm() - obstacle.radius) * (out.norm() + obstacle.radius);
  const double root = towards * towards - a * c;
  if (root < 0 || towards + std::sqrt(root) <= 0) return infinite;
  return side * c / (towards + std::sqrt(root));
}

void read(Obstacle& obstacle, const YAML::Node& node, const std::string& path, deck::Document& document)
{
  const std::string expected =
      "expected the name of a boundary, {plane: {point: [..], normal: [..]}}, {cylinder: {point: [..], axis: [..], radius: ..}} "
      "or "
      "{sphere: {center: [..], radius: ..}}";
  if (!node.IsMap() || node.size() != 1) {
    document.error(path, expected + ", found " + deck::found(node));
    return;
  }
  const auto name = node.begin()->first.Scalar();
  const auto value = node.begin()->second;
  const auto at = path + "." + name;
  document.locate(at, node.begin()->first);
  if (name == "plane") {
    if (const auto plane = read_shape<PlaneOptions>(value, at, document))
      obstacle = {Obstacle::Shape::plane, point(plane->point), point(plane->normal).normalized(), 0, false};
  } else if (name == "cylinder") {
    if (const auto c = read_shape<CylinderOptions>(value, at, document))
      obstacle = {Obstacle::Shape::cylinder, point(c->point), point(c->axis).normalized(), c->radius, c->inside};
  } else if (name == "sphere") {
    if (const auto s = read_shape<SphereOptions>(value, at, document))
      obstacle = {Obstacle::Shape::sphere, point(s->center), Point::UnitY(), s->radius, s->inside};
  } else {
    document.error(at, "unknown obstacle" + deck::suggestion(name, {"plane", "cylinder", "sphere"}));
  }
}

YAML::Node write(const Obstacle& obstacle)
{
  YAML::Node node(YAML::NodeType::Map);
  switch (obstacle.shape) {
    case Obstacle::Shape::plane:
      node["plane"] = deck::Codec<PlaneOptions>::write({array(obstacle.point), array(obstacle.direction)});
      break;
    case Obstacle::Shape::cylinder:
      node["cylinder"] = deck::Codec<CylinderOptions>::write(
          {array(obstacle.point), array(obstacle.direction), obstacle.radius, obstacle.inside});
      break;
    case Obstacle::Shape::sphere:
      node["sphere"] = deck::Codec<SphereOptions>::write({array(obstacle.point), obstacle.radius, obstacle.inside});
      break;
  }
  return node;
}

nlohmann::ordered_json obstacle_schema()
{
  return {{"type", "object"},
          {"properties",
           {{"plane", deck::Codec<PlaneOptions>::schema({})},
            {"cylinder", deck::Codec<CylinderOptions>::schema({})},
            {"sphere", deck::Codec<SphereOptions>::schema({})}}},
          {"additionalProperties", false},
          {"minProperties", 1},
          {"maxProperties", 1}};
}

std::string shape_name(const Obstacle& obstacle)
{
  return obstacle.shape == Obstacle::Shape::plane ? "plane" : obstacle.shape == Obstacle::Shape::cylinder ? "cylinder" : "sphere";
}

std::string misfit(const Obstacle& obstacle, fem::Kinematics kinematics)
{
  if (kinematics == fem::Kinematics::solid) return "";
  const auto along = [&](int axis) { return std::abs(obstacle.direction[axis]) > 1 - 1e-12; };
  const bool turning = kinematics == fem::Kinematics::axisymmetric;
  const double rounding = 1e-12 * std::max(1.0, obstacle.radius);
  const bool on_axis = std::abs(obstacle.point[0]) <= rounding && std::abs(obstacle.point[2]) <= rounding;
  switch (obstacle.shape) {
    case Obstacle::Shape::plane:
      if (turning && !along(1)) return "an axisymmetric obstacle is a body of revolution about y; expected a normal along y";
      if (std::abs(obstacle.direction[2]) > 1e-12) return "a plane model has no z component; expected a normal in x, y";
      return "";
    case Obstacle::Shape::cylinder:
      if (turning && !(along(1) && on_axis))
        return "an axisymmetric obstacle is a body of revolution about y; expected a cylinder with axis: [0, 1, 0] through x = 0";
      if (!turning && !along(2)) return "in a plane model a cylinder is a circle; expected axis: [0, 0, 1]";
      return "";
    case Obstacle::Shape::sphere:
      if (!turning) return "a plane model has no spheres; expected a cylinder, which is a circle there";
      if (!on_axis) return "an axisymmetric obstacle is a body of revolution about y; expected a center with x = 0";
      return "";
  }
  return "";
}

}  // namespace mortise::contact
