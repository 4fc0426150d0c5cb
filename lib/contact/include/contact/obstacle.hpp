// Rigid obstacles without a mesh: planes, cylinders and spheres, solid ones or hollows. The deck's key `primary` of a contact.
#pragma once

#include <limits>
#include <string>

#include "base/types.hpp"
#include "deck/description.hpp"
#include "fem/options.hpp"

namespace mortise::contact {

struct Obstacle {
  enum class Shape { plane, cylinder, sphere };
  Shape shape = Shape::plane;
  Point point = Point::Zero();       ///< on the plane or the axis; the centre
  Point direction = Point::UnitY();  ///< unit: normal of the plane, out of the obstacle; axis of the cylinder
  double radius = 0;
  bool inside = false;  ///< bodies are inside a hollow cylinder or sphere
};

/// How far a point is from the surface, and where it leads.
struct SignedDistance {
  double distance = std::numeric_limits<double>::infinity();  ///< signed, negative inside the obstacle
  Point normal = Point::Zero();                               ///< of the obstacle, unit, towards the bodies
};

/// The signed distance phi(x) and its gradient; exact for every x but those of the axis or the centre, which have no closest
/// point.
SignedDistance signed_distance(const Obstacle& obstacle, const Point& x);

/// How far the surface is from x along a unit vector that leads towards it, signed: positive outside of the obstacle; infinite if
/// it leads past.
double distance_along(const Obstacle& obstacle, const Point& x, const Point& direction);

/// {plane: {point, normal}}, {cylinder: {point, axis, radius, inside}} or {sphere: {center, radius, inside}}: read, written, and
/// as a JSON schema. Errors go to the document.
void read(Obstacle& obstacle, const YAML::Node& node, const std::string& path, deck::Document& document);
YAML::Node write(const Obstacle& obstacle);
nlohmann::ordered_json obstacle_schema();

/// "plane", "cylinder" or "sphere".
std::string shape_name(const Obstacle& obstacle);

/// Why an obstacle does not fit models of this kind: a message, or "". In plane models cylinders have the axis z; in axisymmetry
/// obstacles are bodies of revolution about y.
std::string misfit(const Obstacle& obstacle, fem::Kinematics kinematics);

}  // namespace mortise::contact
