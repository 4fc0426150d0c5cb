// Rows at places between nodes, where the other side comes nearest.
//
// Nodes alone see nothing of a contact narrower than a face. In a contact wider than that they press themselves, and a row that
// stood in for one of them would take what belongs to all round it. So where the faces are covered as a whole, such a place has a
// row of its own beside those of the nodes, a combination of them that is exact for polynomials p of second order in the tangent
// plane, and for its bound the gap of the smooth surfaces there:
//
//     row = sum w_i row_i,    sum w_i p(x_i) = p(x).
//
// Where the nodes round the place touch they say what its row says, and its multiplier is none. Where they are open it presses
// alone, with the forces w_i on the nodes [moving least squares: Lancaster and Salkauskas, Math. Comp. 37 (1981)].
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "constraint/constraints.hpp"
#include "fem/options.hpp"
#include "integrals/face_integrals.hpp"
#include "mesh/instances.hpp"
#include "rows/contact_points.hpp"
#include "rows/supported_nodes.hpp"

namespace mortise::contact {

/// The rows of one contact at this rank's places between nodes, made of the terms of the nodes round them on any rank.
class RowsBetween {
 public:
  struct Setting {
    int contact;  ///< ContactNode::contact
    fem::Kinematics kinematics;
    std::optional<mesh::Motion> rotation;  ///< of the primary side
    bool tangents;                         ///< friction has rows as well
  };
  /// The direction of the row of a place, the gap of the mesh along it, not finite where nothing lies opposite, and the bound of
  /// the row: lengths.
  struct Gap {
    Point direction;
    double mesh, bound;
    Point own_normal;  ///< of the secondary side
  };
  using GapAt = std::function<Gap(const ContactPoint&)>;

  /// `comm` must outlive it. Collective.
  RowsBetween(std::vector<ContactPoint> places, const Side& secondary, const std::vector<char>& own, const Communicator& comm);

  /// Takes up the terms of a contact node of this rank, if a place asks for them, divided by `d`; `means_field`: their row means
  /// the field at the node, see MultiplierPoints.
  void note(const constraint::ContactNode& node, bool means_field, std::span<const Term> terms, double d, const Side& secondary,
            const Side& primary);
  /// Appends the rows, once all nodes are noted. Collective.
  void add_to(constraint::Contacts& contacts, const SupportDirectory& supports, const Setting& setting, const GapAt& gap_at);

 private:
  // A contact node on its way to the places round it.
  struct Neighbour {
    Global node;
    int number;  // among those at the node
    bool means_field;
    double weight, area, cover;
    std::array<double, 3> normal, at;
  };
  // A term of its row.
  struct SentTerm {
    Global node;
    int number;
    bool on_primary;
    Global of;
    double value;
    std::array<double, 3> x;
  };
  using Weighted = std::vector<std::pair<const Neighbour*, double>>;

  std::vector<const Neighbour*> at(std::span<const Global> nodes, const Point& normal) const;
  static void curve_more(const ContactPoint& place, std::span<const Neighbour* const> nodes, Eigen::VectorXd& w);
  Weighted round(const ContactPoint& place, int dimension) const;
  std::vector<Term> sum_of(const Weighted& nodes, const Side& secondary, const Side& primary) const;

  std::vector<ContactPoint> places_;
  const Communicator& comm_;
  bool any_;                      // on any rank
  std::vector<Global> asked_;     // nodes of this rank, ascending
  std::vector<Neighbour> nodes_;  // noted, and later those that were asked for
  std::vector<SentTerm> terms_;   // of these
};

/// Weights w of N points (2 x N, coordinates from a place, in units of the facet's size; in one dimension the second are 0) with
/// sum w_i p(x_i) = p(0) for polynomials of second order; where points do not tell those apart for polynomials of first order,
/// and the others as nearly as they can. Of such weights those of which sum w_i^2 exp |x_i|^2 is least. Empty if there are none
/// that interpolate.
Eigen::VectorXd weights_between(const Eigen::Matrix2Xd& x, int dimension);

}  // namespace mortise::contact
