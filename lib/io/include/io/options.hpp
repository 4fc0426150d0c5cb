// The deck's section `output`.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "deck/description.hpp"

namespace mortise::io {

/// A plane that cuts bodies.
struct PlaneOptions {
  std::array<double, 3> point{0, 0, 0}, normal{0, 0, 0};
  std::optional<double> size;  ///< of the section's cells in bodies of boundary elements; none: a fiftieth of the body's size
};

/// What is to be known of the inside of bodies.
struct InteriorOptions {
  bool cells = false;  ///< bodies of boundary elements are written with their cells, not with their skin
  std::vector<std::array<double, 3>> points;
  std::string point_file;  ///< instead of points; absolute by the time it gets here
  std::map<std::string, PlaneOptions> planes;

  bool any_points() const { return !points.empty() || !point_file.empty(); }
  bool any() const { return cells || any_points() || !planes.empty(); }
};

struct Options {
  std::string directory;  ///< absolute by the time it gets here
  std::vector<std::string> fields{"displacement", "von_mises", "stress"};
  InteriorOptions interior;
};

/// The keywords.
void describe(deck::Description<PlaneOptions>& d);
void describe(deck::Description<InteriorOptions>& d);
void describe(deck::Description<Options>& d);

}  // namespace mortise::io
