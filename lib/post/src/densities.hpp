// Whether a density goes with Young's modulus in some consistent set of units.
#pragma once

#include <optional>
#include <string>

namespace mortise::post {

/// A density that is one of a real material in units other than those that go with Young's modulus.
struct OtherDensity {
  std::string stress, given;  ///< the units that the two numbers are in, as MPa and kg/mm3
  std::string wanted;         ///< the unit that goes with that of stress and of lengths, and says so
  double density = 0;         ///< the given one in that unit
};

/// Where the pair is a real material in no consistent set of units, and is one if the density has a unit that is often mixed up
/// with the right one: that. None for numbers that no such mistake explains, as of models without units.
std::optional<OtherDensity> other_density(double young_modulus, double density);

}  // namespace mortise::post
