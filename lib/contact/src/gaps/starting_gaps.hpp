// The gaps that a contact starts with, at its nodes and between them.
#pragma once

#include "contact/fit.hpp"
#include "gaps/one_surface.hpp"
#include "rows/multiplier_points.hpp"
#include "rows/rows_between.hpp"
#include "search/opposite.hpp"

namespace mortise::contact {

class StartingGaps {
 public:
  /// The gap of the meshes, and what the contact starts with: that, or what the deck or the geometry says.
  struct Gaps {
    double mesh, start;
  };

  /// All of which must outlive it. `reach`: how far the search goes.
  StartingGaps(const Options& options, double reach, const Side& primary, CutFaces& faces, Rays& rays, MultiplierPoints& points,
               const OneSurface& one_surface)
      : options_(options),
        reach_(reach),
        primary_(primary),
        faces_(faces),
        rays_(rays),
        points_(points),
        one_surface_(one_surface)
  {
  }

  /// At a place whose multiplier stands at `at`, along its direction of contact; `mean`: that over its functions, `terms`: of its
  /// row; `nearest`: it stands where the other side comes nearest.
  Gaps at_node(std::size_t place, bool nearest, const Point& at, const Point& direction, double mean,
               std::span<const Term> terms);
  /// Infinite if lines from there meet nothing.
  Gaps between_nodes(const ContactPoint& place, const Point& direction);

  /// Whether a gap is 0 because both faces are parts of one surface of the geometry.
  bool by_geometry(double gap) const { return one_surface_.anywhere() && gap == 0; }

 private:
  bool starts_in_mesh() const { return !options_.clearance && !options_.adjust && !one_surface_.anywhere(); }
  Rays::GapOf start() const;
  /// What a gap is of, in place of its node.
  enum class Beyond { nothing, nearest_place, control_value };
  double without_rounding(std::size_t surface_node, Beyond beyond, double gap, const Point& at, const Point& direction);

  const Options& options_;
  double reach_;
  const Side& primary_;
  CutFaces& faces_;
  Rays& rays_;
  MultiplierPoints& points_;
  const OneSurface& one_surface_;
};

}  // namespace mortise::contact
