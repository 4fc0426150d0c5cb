// From multipliers and displacements back to what an engineer reads on the contact surfaces.
#pragma once

#include <span>
#include <vector>

#include "contact/mortar.hpp"

namespace mortise::contact {

enum class Status : int { open = 0, stick = 1, slip = 2 };

/// The state of one contact node.
struct ContactNodeState {
  int contact = 0;
  Global node = 0;
  double area = 0;                           ///< force over pressure: a constant pressure p has the force p * area
  double cover = 1;                          ///< ContactNode::cover
  Point normal = Point::Zero();              ///< ContactNode::normal
  double force = 0;                          ///< the normal part of force_on_secondary, >= 0 when pressing (bonded: any sign)
  Point force_on_secondary = Point::Zero();  ///< of all its multipliers
  double gap = 0;                            ///< a length, >= 0 up to the solver's tolerance
  Point slip = Point::Zero();                ///< tangential jump, secondary minus primary side, a length
  Status status = Status::open;
  std::vector<constraint::Part> parts = {};  ///< ContactNode::parts
};

/// The state of a contact node. `multipliers`: forces, normal, then tangential. `jumps`: row . u in the same order, of tangential
/// rows without what moving supports and pretension sections contribute. `bound`: of the normal row. `slip_bound`: a force
/// (infinite: sticks; 0: frictionless). A row whose neighbours on the same face have none sees ContactNode::weight times the jump
/// of the surfaces; the state is that of the surfaces. The node is open while its pressure is at most `negligible_pressure`, what
/// the solver's tolerance leaves of zero.
ContactNodeState state_of(const constraint::ContactNode& point, bool bonded, std::span<const double> multipliers,
                          std::span<const double> jumps, double bound, double slip_bound, double negligible_pressure);

/// The states of contact nodes, and after them of their images across a bond, each with its own part of the area and of the
/// force. `states` are those of `nodes`.
std::vector<ContactNodeState> with_images(std::vector<ContactNodeState> states, std::span<const constraint::ContactNode> nodes);

/// Totals of one contact, over all ranks.
struct Resultant {
  Point force = Point::Zero();              ///< on the secondary side
  double area = 0;                          ///< of the nodes that are closed, each for itself
  long long open = 0, stick = 0, slip = 0;  ///< nodes of each status
  double sizes = 0;                         ///< the sum of |force| over the nodes
};
/// Of each of so many `contacts`, from this rank's nodes. Collective.
std::vector<Resultant> resultants(std::span<const ContactNodeState> states, std::size_t contacts, const Communicator& comm);

/// Nodal fields on this rank's secondary surface of one contact: pressures and tractions are forces per area, gaps and slips
/// lengths. Where contact nodes share a node at a kink, the fields are those of the one with the largest pressure. A node whose
/// surroundings the primary side hardly covers bears what presses on a strip much narrower than a face: its force and area count
/// with those of its neighbours, whose mean it shows.
struct SurfaceState {
  std::vector<double> pressure, gap;
  /// The pressure averaged over the faces at each closed node, by their areas; at a kink over those on one side of it. The
  /// pressure of single nodes scatters by some per cent on unstructured meshes; the average loses as much only where the pressure
  /// bends within a face.
  std::vector<double> recovered_pressure;
  std::vector<Point> traction, slip;
  std::vector<int> status;  ///< as Status
  std::vector<char> near;   ///< whether the node lies near enough to the other side to have a state; else the numbers are 0
  std::vector<char> without_rows;  ///< the node shows what its neighbours have
  double area = 0;  ///< of the contact, over all ranks: of the nodes that show a pressure, closed ones and those that share it
};
/// One for each pair. Nodes without rows show the mean of their neighbours, whose rows stand in for them; but no slip.
/// Collective.
std::vector<SurfaceState> surface_states(std::span<const ContactNodeState> states, std::span<const Pair> pairs,
                                         const Communicator& comm,
                                         std::span<const constraint::NodeWithoutRows> without_rows = {});

}  // namespace mortise::contact
