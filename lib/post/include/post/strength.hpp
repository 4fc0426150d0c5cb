// Forces and errors that the model cannot mean: pressures of the size of Young's modulus, supports that carry too much for their
// area, meshes too coarse for what they show.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "base/warning.hpp"
#include "contact/state.hpp"
#include "feti/drives.hpp"
#include "post/bodies.hpp"

namespace mortise::post {

/// "large_pressure": the recovered pressure of a contact exceeds a hundredth of the smaller Young's modulus of its bodies.
/// `softest`: of each body its smallest Young's modulus; `bodies`: their names; `surfaces` as of contact::surface_states().
/// Collective.
std::vector<Warning> large_pressures(std::span<const contact::SurfaceState> surfaces, std::span<const contact::Pair> pairs,
                                     const std::vector<double>& softest, const std::vector<std::string>& bodies,
                                     const Communicator& comm);

/// "narrow_contact": a contact presses, but on no face of its secondary side at all corners, so that it is narrower than these
/// faces: its area, its pressures and how far bodies approach are those of the mesh. Or on one or two faces across, on which a
/// pressure that is not even loses more than a sixth in the mean over faces. Patches of faces that hang together are judged each
/// for itself, where they matter beside the others of their contact and bear more than `nothing`, a force. Collective.
std::vector<Warning> narrow_contacts(std::span<const contact::SurfaceState> surfaces,
                                     std::span<const contact::ContactNodeState> states, std::span<const contact::Pair> pairs,
                                     double nothing, const Communicator& comm);

/// "scattered_contact": a secondary side of smaller faces and more than four times the other side's Young's modulus presses on
/// few faces at all corners, on twice as many, eight at least, at some: the soft side's faces cannot follow a stiff one between
/// their nodes, so that single points bear what all should. `softest` as in large_pressures(). Collective.
std::vector<Warning> scattered_contacts(std::span<const contact::SurfaceState> surfaces, std::span<const contact::Pair> pairs,
                                        const std::vector<double>& softest, const Communicator& comm);

/// The largest tension, force over area at one point, of each contact; 0 where none pulls. Collective.
std::vector<double> largest_tensions(std::span<const contact::ContactNodeState> states, std::size_t contacts,
                                     const Communicator& comm);

/// What a support does, and what it lies on.
struct SupportLoad {
  std::string boundary;
  std::array<double, 3> force{};  ///< resultant
  double area = 0;                ///< of its faces; of the whole turn in axisymmetry, in planes times the thickness 1
  Point centre = Point::Zero();
  double young_modulus = 0;  ///< mean of its bodies over the area, for the stiff ones carry most
};

/// "strained_support": resultant over area exceeds a hundredth of Young's modulus: no real seat bears that, so the area is not
/// what was meant (a sliver, one face of a mesh to stop a rigid motion), or the load is not. `forces`: the largest force of the
/// model; a resultant below a millionth of it is rounding.
std::vector<Warning> strained_supports(const std::vector<SupportLoad>& supports, double forces);

/// What acts on single nodes: a load or a support at points or along a curve.
struct PointForce {
  std::string name;  ///< "load tip", "support legs"
  double force = 0;  ///< length of the resultant
};

/// "point_force": a force on nodes alone, of more than a thousandth of `forces`, the largest of the model: elasticity has no
/// finite stress there, so that what a mesh shows depends on its size.
std::vector<Warning> point_forces(const std::vector<PointForce>& found, double forces);

/// Where the estimated error of the mesh is.
struct MeshError {
  double relative = 0;       ///< of all, in the energy norm
  std::vector<Found> cells;  ///< of each body: the largest squared error of a cell, at the cell's centre
  std::vector<double> part;  ///< of each body: its part of the squared error
  double squared_norm = 0;   ///< what `relative` is measured by
};

/// "coarse_mesh": the relative error exceeds 25 %.
std::vector<Warning> coarse_mesh(const MeshError& error, const std::vector<std::string>& bodies);

/// "facet_push": facets push bodies along motions that nothing resists with more than a thousandth of the largest force. `force`:
/// of the gauges that hold against it; `part`: Balance::push_of_facets.
std::vector<Warning> facet_push(double part, const Point& force);

/// "unresisted_load": loads work on motions that nothing resists, or facets alone, by too little to be refused.
std::vector<Warning> unresisted_loads(std::span<const feti::UnresistedLoad> found, const std::vector<std::string>& bodies);

}  // namespace mortise::post
