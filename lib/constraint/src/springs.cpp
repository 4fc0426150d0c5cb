#include "constraint/springs.hpp"

namespace mortise::constraint {

void describe(deck::Description<SpringOptions>& d)
{
  d.help("A spring between two points of bodies, along the line through them. Springs to the ground: `stiffness` of a support.");
  d.key("points", &SpringOptions::points,
        "The two places, coordinates or names of points of the mesh; a node of a surface must lie at each.")
      .required();
  d.key("bodies", &SpringOptions::bodies, "Of each point, whose node is meant, where several bodies have one there.");
  d.key("stiffness", &SpringOptions::stiffness, "Force a length.").positive().required();
  d.check([](const SpringOptions& spring, const std::string& path, deck::Document& document) {
    if (spring.points.size() != 2) {
      document.error(path + ".points", "expected two points, found " + std::to_string(spring.points.size()));
    } else if (spring.points[0] == spring.points[1]) {
      document.error(path + ".points",
                     "the two points are one, so that the spring has no direction; hold them together by a "
                     "bonded contact, or name places apart");
    }
    if (!spring.bodies.empty() && spring.bodies.size() != 2)
      document.error(path + ".bodies", "expected two bodies, one for each point, found " + std::to_string(spring.bodies.size()));
  });
}

}  // namespace mortise::constraint
