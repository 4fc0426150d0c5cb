// Linear constraints on nodal displacements in mesh numbering, before anyone knows of subdomains:
//
//     sum_k  c_k u(node_k, component_k)  =  g        supports, bonded contacts
//     sum_k  c_k u(node_k, component_k) <=  g        normal rows of contacts; their multipliers are pressures times areas, >= 0
//     |tangential multipliers of a point| <= slip bound of the point      tangential rows
//
// Each rank holds rows of its own; a row stands on exactly one rank and may speak of nodes that live on others.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/types.hpp"
#include "constraint/entry.hpp"
#include "constraint/springs.hpp"

namespace mortise::constraint {

/// Rows sum c_k u(node_k, component_k), in compressed storage.
struct Rows {
  std::vector<std::size_t> offset{0};
  std::vector<Entry> entries;
  std::vector<double> bound;  ///< g of each row

  std::size_t size() const { return bound.size(); }  ///< number of rows
  /// The entries of the i-th row.
  std::span<const Entry> operator[](std::size_t i) const
  {
    return std::span(entries).subspan(offset[i], offset[i + 1] - offset[i]);
  }
  /// Closes a row whose entries were appended to `entries`.
  void close(double g)
  {
    offset.push_back(entries.size());
    bound.push_back(g);
  }
};

/// A component of a node is prescribed at `value` (same unit as the mesh's coordinates).
struct PrescribedDof {
  Global node;
  int component;
  double value;
  int support;                  ///< index into the deck's supports, for messages and reactions
  std::array<double, 3> at{};   ///< the node's place, for moments
  int coupling = -1;            ///< the rigid coupling that prescribes it, or -1
  bool unknown = false;         ///< an unknown motion of that coupling moves this component besides `value`
  std::array<double, 3> arm{};  ///< from the coupling's point to the node
};

/// A node is prescribed at `value` along a direction that is no axis: orthogonal to the components that are prescribed there and
/// to its other skew directions. Supports that are not orthogonal to each other share it.
struct SkewSupport {
  Global node;
  std::array<double, 3> direction;  ///< unit
  double value;                     ///< a length
  /// Its force, a multiplier times `direction`, comes from these supports, each along its own normal or axis: the multiplier
  /// times `part`. The sum of the parts is `direction`.
  struct Share {
    int support;
    std::array<double, 3> part;
  };
  std::array<Share, 4> shares;
  int share_count;
  std::array<double, 3> at{};  ///< the node's place
  bool along_normals = false;  ///< all of its supports act along the normals of their boundaries

  /// Adds `part` to what goes to this support. Four are enough: a node has at most three directions, each with a share of
  /// its own and those of the directions before.
  void add_share(int support, const Point& part)
  {
    int k = 0;
    while (k < share_count && shares[static_cast<std::size_t>(k)].support != support) ++k;
    auto& share = shares[static_cast<std::size_t>(k)];
    if (k == share_count) share = {support, {0, 0, 0}}, ++share_count;
    for (int c = 0; c < 3; ++c) share.part[static_cast<std::size_t>(c)] += part[c];
  }
};

/// What a row between nodes pushes on one of them with.
struct Part {
  Global node;
  double part;   ///< of its multiplier
  Point normal;  ///< of the node's own row
};

/// The part of a row that stands across a bond, also at the other cut of a sector: what it pushes with there is its own, rotated.
struct Image {
  int contact;  ///< ContactNode::contact there
  Global node;
  double part;
  Eigen::Matrix3d rotation;
};

/// A node of the secondary side that carries multipliers, or one side of a kink at that node.
struct ContactNode {
  int contact;                  ///< index into the deck's contacts
  Global node;                  ///< of the secondary surface
  double area;                  ///< integral of its shape function over the overlap, which turns a multiplier into a traction
  Point normal;                 ///< unit, out of the secondary body
  std::vector<Point> tangents;  ///< 0, 1 (2D, or one direction is prescribed) or 2 unit vectors, orthogonal to the normal
  std::size_t row;              ///< its normal row in Contacts::rows; its tangential rows follow, then the next node's normal row
  double weight = 1;  ///< sum of the row's coefficients on the secondary side, above 1 where it stands in for dropped nodes
  double gap = 0;     ///< times `weight`, interference deducted, before any support moves
  Point at = Point::Zero();  ///< its place in the mesh: the node, or where the node was moved to at the primary side's border
  /// Part of its surroundings that lies opposite the primary side. Where the node was moved, at most half of the part that is
  /// left of the way to the next nodes: that of a surface which goes on beyond its border.
  double cover = 1;
  std::vector<Part> parts = {};    ///< of a place between nodes, whose row is a combination of theirs: these, and what they bear
  std::vector<Image> images = {};  ///< of a contact that goes on across a bond: the nodes whose rows this one is as well
  /// Part of the row at places that supports hold on both sides: what overlaps there nothing can close.
  double prescribed_share = 0;
  /// Of a bond where supports of both sides hold its surface's normal, but not all else: `normal` lies in the surface, and what
  /// acts along it is no pressure.
  bool in_surface = false;
  Point across = Point::Zero();  ///< of a bond: the unit normal of its surface, whatever supports leave of that
};

/// Bound of its normal row before any support moves, a length: the gap, or what of an overlap can be closed.
inline double bound_of(const ContactNode& node)
{
  return node.gap - node.prescribed_share * std::min(node.gap, 0.0);
}

/// An entry of a contact row that a support holds: it stands in the row's bound instead, and what the row's multiplier pushes
/// there goes straight into the support.
struct PrescribedEntry {
  std::size_t row;  ///< of Contacts::rows
  int component;
  int support;
  double coefficient;
  std::array<double, 3> at{};   ///< the node's place
  int coupling = -1;            ///< the rigid coupling that holds it instead, whose motion is known there
  std::array<double, 3> arm{};  ///< from the coupling's point to the node
};

/// A node of the secondary side, or one side of a kink there, that has no rows: those of its faces' other nodes stand in for it.
struct NodeWithoutRows {
  int contact;
  Global node;
  std::array<double, 3> normal;
  Global opposite = -1;  ///< of a bond on faces whose nodes lie opposite nodes: that one
};

/// Contact rows. A frictionless contact emits normal rows only. A row states the jump at the node in length units, with the
/// coefficient of the secondary node n (normal row) or t (tangential): (u_s - sum_j m_j u_j) . n <= gap. Its multiplier is a
/// force. Rows have no entries at prescribed components, so they are independent of the supports. A tangential row along which
/// supports hold both sides has no entries at all: the slip stands in its bound, and friction goes straight into the supports.
struct Contacts {
  Rows rows;
  std::vector<PrescribedEntry> prescribed;
  std::vector<ContactNode> nodes;
  std::vector<bool> bonded;  ///< for each node: all its rows are equalities
  std::vector<NodeWithoutRows> without_rows = {};  ///< of this rank; each once over all ranks
  /// Of each row: the tangential jump at the end of the load step before, from which friction counts. Part of the row's bound.
  /// Empty before the first step ends.
  std::vector<double> slipped;

  /// That of one row, in length units; 0 before the first step ends.
  double slipped_before(std::size_t row) const { return slipped.empty() ? 0.0 : slipped[row]; }
};

/// How a bonded contact is drawn together: to a force, whatever shortening that takes, or by a given shortening.
struct Preload {
  int contact = -1;             ///< index into the deck's contacts
  std::string name = {};        ///< of the contact, for messages
  std::optional<double> force;  ///< tension of the bolt, > 0 (plane models: per thickness; axisymmetric: of the whole turn)
  double shortening = 0;        ///< a length, where no force is given
};

/// A preloaded contact. Its two sides jump by s n, n the mean normal out of the secondary body, as if a slice of thickness s were
/// cut out of the bolt: row . u = g + part s. Where a force F is given s is one more unknown; the energy is stationary in it if
/// -sum of part * multiplier = F.
struct PretensionSection {
  Preload preload;
  Point normal;
  struct Row {
    std::size_t row;  ///< of Contacts::rows
    double part;      ///< weight of the node times n . axis of the row
  };
  std::vector<Row> rows;  ///< those of this rank
};

/// A boundary that is coupled to a point, in one load state; see constraint/coupling.hpp. Components: the motion U of the point,
/// then its angles T.
struct Coupling {
  std::string name;
  bool rigid = false;
  Point point = Point::Zero();
  std::array<std::optional<double>, 6> motion;  ///< what supports prescribe of it: lengths, then radians
  std::array<double, 6> load{};                 ///< force and moment at the point
  double arm = 1;                               ///< how far the boundary is from the point, root mean square
};

/// The mean motion of a distributing coupling is prescribed in one component: sum c u = value, an angle times Coupling::arm.
struct MeanMotion {
  int coupling, component;
  double value;
  std::vector<Entry> entries;
};

/// All constraints of an assembly, in mesh numbering.
struct Constraints {
  std::vector<PrescribedDof> prescribed;  ///< each pair (node, component) once over all ranks
  Contacts contacts;
  std::vector<SkewSupport> skew_supports = {};              ///< of this rank; each once over all ranks
  std::vector<PretensionSection> pretension_sections = {};  ///< the same on every rank, but for their rows
  std::vector<Coupling> couplings = {};                     ///< the same on every rank
  std::vector<MeanMotion> mean_motions = {};                ///< of this rank; each once over all ranks
  Springs springs = {};
};

}  // namespace mortise::constraint
