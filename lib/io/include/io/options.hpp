// The deck's section `output`.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/types.hpp"
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

/// What is to be followed through all states: the largest or smallest value of a quantity (fem/quantity.hpp), the values at a
/// point, or along the straight path between two.
struct ProbeOptions {
  std::string largest, smallest;  ///< names of quantities; one of them, or
  std::optional<std::array<double, 3>> point, from, to;
  std::string axes;          ///< name of those that components are along; empty: those of the model
  std::string of;            ///< of extremes: bodies or a boundary, where; of pressures also contacts. Empty: everywhere
  std::optional<int> count;  ///< of points on a path

  static constexpr int usual_count = 21;
  bool is_extreme() const { return !largest.empty() || !smallest.empty(); }
  bool is_path() const { return from.has_value(); }
  /// That of extremes.
  const std::string& quantity() const { return largest.empty() ? smallest : largest; }
  /// The points that it asks for: one, those of the path, ends included, or none.
  std::vector<std::array<double, 3>> points() const;
};

struct Options {
  static constexpr std::size_t usual_blocks = 40;
  static constexpr Global usual_nodes = 30000;  ///< so that blocks take a tenth of a second
  std::string directory;                        ///< absolute by the time it gets here
  std::vector<std::string> fields{"displacement", "von_mises", "stress", "principal_stress"};
  std::string axes;           ///< name of those that displacement_local and stress_local are along
  deck::OrAuto<bool> blocks;  ///< blocks.pvd; auto: where it has at most `usual_blocks` of `usual_nodes`
  int every = 1;              ///< increment of a load step is written, and its last one
  std::array<double, 3> moments_about{0, 0, 0};
  std::map<std::string, ProbeOptions> probes;
  InteriorOptions interior;

  /// Whether `fields` has this one.
  bool has_field(const std::string& name) const;
  /// Whether something inside bodies of boundary elements may be asked for.
  bool asks_inside() const;
};

/// The keywords.
void describe(deck::Description<PlaneOptions>& d);
void describe(deck::Description<InteriorOptions>& d);
void describe(deck::Description<ProbeOptions>& d);
void describe(deck::Description<Options>& d);

}  // namespace mortise::io
