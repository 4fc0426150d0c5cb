// Discretizations of contact, in one table: what of the secondary faces counts, and what their functions add to the rows.
#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "integrals/cut_faces.hpp"
#include "integrals/face_integrals.hpp"
#include "rows/contact_points.hpp"
#include "search/line_of_sight.hpp"
#include "search/nearest_points.hpp"
#include "search/opposite.hpp"

namespace mortise::contact {

/// One contact, as a discretization sees it. Refers to its parts, which outlive it.
struct TwoSides {
  const Side& secondary;
  const SurfaceNodes& surface_nodes;
  const Side& primary;
  const SurfaceNodes& primary_nodes;
  const Tree& tree;                               ///< of the primary facets
  const LineOfSight& sight;                       ///< between the two sides
  CutFaces& faces;                                ///< of the secondary side
  Rays& rays;                                     ///< from the surface nodes
  bool obstacle;                                  ///< the primary side is rigid and has no faces
  double reach;                                   ///< what lies farther away does not count
  bool mesh_gaps;                                 ///< the contact starts with the gaps of the meshes
  bool corners;                                   ///< those of the primary side have rows of their own
  const std::vector<NearestPoint>& nearest;       ///< of each surface node, or none
  const std::vector<std::vector<Local>>& bonded;  ///< nodes of the primary side that each bond holds together
};

class Discretization {
 public:
  explicit Discretization(const TwoSides& sides) : sides_(sides) {}
  virtual ~Discretization() = default;

  /// Adds the next face of faces.round() in pieces, with their integrals over what meets the other side; `in_facets`: of each of
  /// its facets in any case.
  virtual void add_face(std::size_t face, bool in_facets) = 0;
  /// What the other side covers of a face, if places between its nodes can have rows of their own. Before faces are added.
  virtual Cover cover(std::size_t /*face*/) { return {}; }
  /// Turns the integrals of all pieces into functions of the surface nodes that are `kept`; those of the others become 0.
  virtual void make_functions(std::span<const char> kept) = 0;
  /// Adds what one function, once made, adds to the row of its surface node.
  virtual void add_terms(const CutFaces::Function& function, std::vector<Term>& terms) = 0;
  /// Its integral of how far both surfaces bulge out of their facets: what the mean gap of the facets is too large by.
  virtual double rise(const CutFaces::Function& /*function*/) { return 0; }
  /// Whether a bonded seam leaves out the surface nodes where it ends at a contact.
  virtual bool seams_end_at_contacts() const { return true; }
  /// Whether functions of others stand in for those of surface nodes that are not kept.
  virtual bool others_take_over() const { return true; }

 protected:
  const TwoSides sides_;
};

/// One row of the table.
struct DiscretizationKind {
  std::string_view name;  ///< in the deck
  std::string_view help;
  /// Which side is the secondary one may be chosen by the program: both have multipliers that mean the same.
  bool sides_alike;
  std::unique_ptr<Discretization> (*make)(const TwoSides& sides);
};

/// The table. To add a discretization: a file with its class and the function that makes it, and a row.
std::span<const DiscretizationKind> discretizations();

/// The row of a name in the deck; of one that is not in it the first.
const DiscretizationKind& discretization_kind(std::string_view name);

std::unique_ptr<Discretization> make_mortar(const TwoSides& sides);
std::unique_ptr<Discretization> make_node_to_segment(const TwoSides& sides);

}  // namespace mortise::contact
