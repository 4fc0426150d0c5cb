// Instances: one part of the mesh at many places. The part is read, meshed and cut once; its copies differ by a rigid motion, and
// so do their subdomains.
#pragma once

#include <array>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "deck/description.hpp"
#include "mesh/mesh.hpp"

namespace mortise::mesh {

/// A rigid motion: x -> rotation x + translation.
struct Motion {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Point translation = Point::Zero();
  Point operator()(const Point& x) const { return rotation * x + translation; }
};
/// x -> second(first(x)).
Motion compose(const Motion& second, const Motion& first);

struct RotationOptions {
  std::array<double, 3> axis{0, 0, 1};    ///< of any length but zero
  double angle = 0;                       ///< degrees, right-handed
  std::array<double, 3> center{0, 0, 0};  ///< a point on the axis
};

/// The motion M: first the rotation, then the translation. Without a count it makes one copy, moved by M; with a count the copies
/// moved by M^0 (none), M^1, .. M^(count - 1). `of`: what is copied, if it is not the part alone: instances in turn, each of
/// which then moves by M as well.
struct InstanceOptions {
  std::optional<int> count;
  std::array<double, 3> translate{0, 0, 0};
  std::optional<RotationOptions> rotate;
  std::vector<InstanceOptions> of;
};

/// The motion of every copy: entry by entry; in each, power by power of M, all of `of`.
std::vector<Motion> motions(const std::vector<InstanceOptions>& instances);

/// How many copies these are, which may be more than an integer holds: to be asked before motions().
double count_of(const std::vector<InstanceOptions>& instances);

/// At most so many copies of one part.
inline constexpr int most_instances = 10000;

/// The indices of the first two motions that are the same, to 1e-9 of the translations; nothing if all differ.
std::optional<std::pair<std::size_t, std::size_t>> coinciding(const std::vector<Motion>& motions);

/// The keywords.
void describe(deck::Description<RotationOptions>& d);
void describe(deck::Description<InstanceOptions>& d);

/// A body of the assembly as a copy of a body of the parts.
struct PartInstance {
  int part;                       ///< index into the parts' bodies
  std::optional<Motion> motion;   ///< none: it is the part
  Global node_shift, cell_shift;  ///< to be added to the part's numbers
  std::vector<int> own_boundary;  ///< for each boundary of the parts the one that is this copy's alone, or -1; empty: none
};

/// The assembly that is made of the parts.
struct Layout {
  Catalogue catalogue;               ///< of the assembly: its first boundaries are those of the parts
  std::vector<PartInstance> bodies;  ///< for each body of `catalogue`
};

/// `instances`: the motions by group. Instance i (from 1) of the group "roller" is the body "roller.i" (parts of it, if the group
/// is not connected, are "roller.i.1", "roller.i.2", ..), and of each boundary of the part it has one of its own: of "surface",
/// "roller.surface" and "roller_surface" alike "roller.i.surface". The boundaries of the parts mean those of all instances.
/// first_node and first_cell: for each body of the parts the number of its first node and cell, and the totals.
/// on_part: pairs (boundary, body of the parts) for the boundaries that lie on groups with instances.
/// Throws Error(bad_input) if a name is taken.
Layout lay_out(Catalogue parts, const std::map<std::string, std::vector<Motion>>& instances,
               const std::vector<Global>& first_node, const std::vector<Global>& first_cell,
               const std::set<std::pair<int, int>>& on_part);

/// A piece of a part, moved and numbered as a piece of the assembly's body number `body`.
Mesh instantiate(Mesh piece, const PartInstance& instance, int body);

}  // namespace mortise::mesh
