// Fits: the gap that a contact starts with. Meshes have it only to their own error, which on curved surfaces is as large as many
// a fit; the deck or the geometry may have it exactly. Gaps are lengths, negative where the sides overlap.
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

/// Up to this gap surfaces are near each other for their size: the smaller of 1e-4 of the `extent` of the smaller side and 1e-3
/// of the largest secondary `face`.
double touching_gap(double extent, double face);
/// Part of touching_gap() above which an overlap is no rounding.
inline constexpr double overlapping = 0.01;
/// Part of touching_gap() that coordinates leave of a gap 0.
inline constexpr double gap_rounding = 1e-6;

/// What a contact starts with at its contact nodes, before any interference and before anything moves. Of bonded ones what the
/// meshes leave between the two sides.
struct InitialGap {
  double smallest = std::numeric_limits<double>::infinity();  ///< negative: an overlap; infinite: there are no nodes
  std::array<double, 3> at{0, 0, 0};                          ///< where that is
  double largest = -std::numeric_limits<double>::infinity();
  double touching = 0;        ///< see touching_gap()
  double touching_area = 0;   ///< of the nodes that touch or overlap, gap 0 but for rounding
  double near_area = 0;       ///< of those up to `touching`
  double area = 0;            ///< of all nodes
  double on_one_surface = 0;  ///< area where the geometry says that both faces are one surface
  /// The smallest and the largest gap of the meshes where another one is taken.
  double least_in_mesh = std::numeric_limits<double>::infinity(), largest_in_mesh = -least_in_mesh;

  /// Those of the meshes at all nodes, and where the largest is.
  double mesh_smallest = std::numeric_limits<double>::infinity(), mesh_largest = -mesh_smallest;
  std::array<double, 3> mesh_largest_at{0, 0, 0};
  double face = 0;  ///< the longest distance of two corners of a secondary face
  /// The largest turn of a round surface that one face with nodes that touch spans, in radians, where only the meshes say what the
  /// gap is; how far the face stands back from it between its nodes, about, and where.
  double turn = 0, rise = 0;
  std::array<double, 3> turn_at{0, 0, 0};

  /// In length units; 0 where nothing overlaps.
  double largest_overlap() const { return smallest < 0 ? -smallest : 0; }
  /// Whether there is an overlap by more than rounding.
  bool overlaps() const { return -smallest > overlapping * touching; }
};

/// The gap of a contact node where that of the meshes is `mesh_gap`: options.clearance if it is given, else 0 up to
/// options.adjust if that is, else 0 where both faces are parts of one surface of the geometry; `mesh_gap` otherwise.
double starting_gap(const Options& options, double mesh_gap, bool one_surface);

/// Whether the geometry is asked at all: the deck says nothing else.
bool asks_geometry(const Options& options);

/// Adds a contact node to `all`.
void note_gap(InitialGap& all, double gap, double mesh_gap, bool one_surface, double area, const Point& at);

/// Takes the turn that a face with its middle at `at` spans, if it is the largest.
void note_turn(InitialGap& all, double turn, double rise, const Point& at);

/// The initial gap over the nodes of all ranks. Collective.
InitialGap over_ranks(InitialGap mine, const Communicator& comm);

}  // namespace mortise::contact
