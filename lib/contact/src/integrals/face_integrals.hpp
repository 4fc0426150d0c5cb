// The integrals of one secondary face over its covered part.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "integrals/common_parts.hpp"
#include "integrals/covered_basis.hpp"
#include "integrals/covered_face.hpp"
#include "integrals/pieces.hpp"
#include "rows/contact_points.hpp"
#include "search/line_of_sight.hpp"
#include "search/nearest_points.hpp"
#include "search/tree.hpp"
#include "surface/bulge.hpp"

namespace mortise::contact {

/// Integrates over secondary faces and what lies opposite them. Holds room to work in.
class Integrator {
 public:
  /// All of which must outlive it. `tree` has the facets of the primary side; `nearest` are those of nearest_points(). `corners`:
  /// those of the common base have rows of their own. `bonded`: see TwoSides.
  Integrator(const Side& secondary, const SurfaceNodes& secondary_nodes, const Side& primary, const SurfaceNodes& primary_nodes,
             const Tree& tree, const LineOfSight& sight, double reach, bool corners, const std::vector<NearestPoint>& nearest,
             std::span<const std::vector<Local>> bonded);
  /// Everything on the primary side that a face looks at within reach: one piece, or those of its facets; `in_facets`: of these
  /// in any case. Valid until the next call.
  std::span<const PieceIntegrals> integrate(std::size_t face, bool in_facets);
  /// The same where a rigid obstacle lies opposite all of the face, which has no nodes.
  std::span<const PieceIntegrals> integrate_whole(std::size_t face, bool in_facets);
  /// What the primary side covers of a face within reach.
  Cover cover(std::size_t face);

 private:
  void begin(std::size_t face);
  void start(std::size_t face, Local facet, std::size_t functions = 0);
  void forget_nodes();
  void integrate_face(std::size_t face);
  void integrate_facet(std::size_t facet);
  void cut(std::size_t face, bool in_facets);
  double slits(std::size_t face) const;
  void move_points(std::size_t face);
  void cut_into_facets(std::size_t face);
  bool moved(std::size_t face) const;
  SmallMatrix points_of(std::size_t facet) const;
  void add_whole(std::size_t facet);
  template <class Add>
  void over_facet(std::size_t facet, const Add& add);
  void add_pair(std::size_t facet, std::size_t other, const Bulge& own_bulge);
  template <class Vector, class Matrix>
  void add_points(std::size_t facet, std::size_t other, const Bulge& own_bulge, Vector zero, Matrix square, Matrix mass,
                  Matrix across);

  const Side& secondary_;
  const SurfaceNodes& secondary_nodes_;
  const Side& primary_;
  const SurfaceNodes& primary_nodes_;
  CommonParts common_parts_;
  const std::vector<NearestPoint>& nearest_;  // of each surface node of the secondary side, or none
  std::vector<PieceIntegrals> pieces_;
  PieceIntegrals* piece_ = nullptr;  // at work: the last of pieces_, if there is one
  std::vector<Local> slot_;          // of each primary node its place in piece_->nodes, or -1
  Overlap overlap_;
  std::vector<Polygon> common_;        // what the facet at work has in common with the primary facets
  CoveredFace covered_face_;           // at work, if it is cut
  std::optional<CoveredBasis> basis_;  // if it has points of its own
  std::span<const std::vector<Local>> bonded_;
  std::vector<Local> body_of_;  // of each primary node, once it is asked for
};

/// One coefficient of the rows before they are divided by D: secondary or primary node, value.
struct Term {
  Local node;
  bool on_primary;
  double value;
};

}  // namespace mortise::contact
