// Fits: the gap that a contact starts with. Meshes know it only to their own error, which on curved surfaces is as large as many
// a fit; the deck or the geometry may know better.
#pragma once

#include <array>
#include <limits>

#include "base/communicator.hpp"
#include "contact/options.hpp"
#include "mesh/curved_surface.hpp"

namespace mortise::contact {

/// A face that lies on a curved surface of the geometry, as plain bytes.
struct CurvedFace {
  CurvedFace() = default;
  CurvedFace(Global face, const mesh::CurvedSurface& s)
      : node(face),
        point{s.point[0], s.point[1], s.point[2]},
        axis{s.axis[0], s.axis[1], s.axis[2]},
        radius(s.radius),
        slope(s.slope)
  {
  }
  /// The surface as lib/mesh has it.
  mesh::CurvedSurface surface() const { return {Point(point.data()), Point(axis.data()), radius, slope}; }

  Global node = 0;  ///< the face's number, Surface::face_id; named as by_node() wants it
  std::array<double, 3> point{}, axis{};
  double radius = 0, slope = 0;
};

/// Up to this gap surfaces count as touching: 1e-4 of the extent of the smaller side, and 1e-3 of the largest secondary face.
double touching_gap(double extent, double face);
/// Part of that above which an overlap is no rounding.
inline constexpr double overlapping = 0.01;

/// What a contact starts with at its points, before any interference and before anything moves. Of bonded ones what the meshes
/// leave between the two sides.
struct InitialGap {
  double smallest = std::numeric_limits<double>::infinity();  ///< negative: an overlap; infinite: there are no points
  std::array<double, 3> at{0, 0, 0};                          ///< where that is
  double largest = -std::numeric_limits<double>::infinity();
  double touching = 0;        ///< see touching_gap()
  double touching_area = 0;   ///< of the points that touch or overlap
  double area = 0;            ///< of all points
  double on_one_surface = 0;  ///< area where the geometry says that both faces are one surface
  /// What the meshes say, smallest and largest, if something else was taken.
  double least_in_mesh = std::numeric_limits<double>::infinity(), largest_in_mesh = -least_in_mesh;

  /// In length units; 0 where nothing overlaps.
  double largest_overlap() const { return smallest < 0 ? -smallest : 0; }
  /// By more than rounding.
  bool overlaps() const { return -smallest > overlapping * touching; }
};

/// The gap of a point where the meshes say `mesh_gap`: options.clearance, or 0 for what options.adjust allows, or 0 where both
/// faces are one surface.
double starting_gap(const Options& options, double mesh_gap, bool one_surface);

/// Whether the geometry is asked at all: the deck says nothing else.
bool asks_geometry(const Options& options);

/// Takes note of a point.
void note_gap(InitialGap& all, double gap, double mesh_gap, bool one_surface, double area, const Point& at);

/// The same over all ranks. Collective.
InitialGap over_ranks(InitialGap mine, const Communicator& comm);

}  // namespace mortise::contact
