// Contact of nodes with the faces opposite: each node with its part of the faces round it, whole or not at all.
#include "rows/discretization.hpp"

namespace mortise::contact {

namespace {

class NodeToSegment : public Discretization {
 public:
  explicit NodeToSegment(const TwoSides& sides)
      : Discretization(sides),
        integrator_(sides.secondary, sides.surface_nodes, sides.primary, sides.primary_nodes, sides.tree, sides.sight,
                    sides.reach, false, none_, sides.bonded)
  {
  }

  // A function is taken out if one of the nodes whose values it sees meets nothing.
  void add_face(std::size_t face, bool in_facets) override
  {
    auto& faces = sides_.faces;
    faces.add(face, integrator_.integrate_whole(face, in_facets || (sides_.mesh_gaps && sides_.rays.nearest_within(face))));
    const auto surface_nodes = faces.surface_nodes_of(face);
    for (const std::size_t i : faces.pieces(face)) {
      const auto piece = faces.piece(i);
      auto covered = piece.covered;
      for (Eigen::Index k = 0; k < covered.size(); ++k)
        each_seen(face, piece, k, [&](std::size_t node, double) {
          if (!sides_.rays.meets(static_cast<std::size_t>(surface_nodes[node]))) covered[k] = 0;
        });
    }
  }

  void make_functions(std::span<const char> /*kept*/) override {}  // they are those of the nodes

  // u_s - sum_j N_j u_j at what each node meets, weighted with the node's share of the face.
  void add_terms(const CutFaces::Function& function, std::vector<Term>& terms) override
  {
    const Side &secondary = sides_.secondary, &primary = sides_.primary;
    const auto surface_nodes = sides_.faces.surface_nodes_of(function.face);
    const auto nodes = secondary.faces[function.face];
    const auto piece = sides_.faces.piece(function.piece);
    each_seen(function.face, piece, function.k, [&](std::size_t node, double part) {
      const double weight = part * piece.covered[function.k];
      if (weight == 0) return;
      terms.push_back({nodes[node], false, weight});
      if (sides_.obstacle) return;
      const Opposite& opposite = sides_.rays.meet(static_cast<std::size_t>(surface_nodes[node]));
      const auto other = primary.faces[static_cast<std::size_t>(primary.face_of[opposite.facet])];
      const FaceShape shape = primary.shape_in_face(opposite.facet, opposite.hit.shape, opposite.hit.frame, Plane::Zero());
      for (std::size_t j = 0; j < other.size(); ++j)
        terms.push_back({other[j], true, -weight * shape[static_cast<Eigen::Index>(j)]});
    });
  }

  bool seams_end_at_contacts() const override { return false; }
  bool others_take_over() const override { return false; }

 private:
  // Calls see(node of the face, part) for the values that a function's row sees: of a facet's function the node's own, else those
  // of its control value.
  template <class See>
  void each_seen(std::size_t face, const PieceStore::View& piece, Eigen::Index k, const See& see) const
  {
    if (piece.facet >= 0)
      return see(
          static_cast<std::size_t>(sides_.secondary.corners[static_cast<std::size_t>(piece.facet)][static_cast<std::size_t>(k)]),
          1.0);
    const auto& control = control_values(sides_.secondary.faces.type[face]);
    for (Eigen::Index l = 0; l < control.cols(); ++l)
      if (control(k, l) != 0) see(static_cast<std::size_t>(l), control(k, l));
  }

  const std::vector<NearestPoint> none_;  // its rows stay at the nodes
  Integrator integrator_;
};

}  // namespace

std::unique_ptr<Discretization> make_node_to_segment(const TwoSides& sides)
{
  return std::make_unique<NodeToSegment>(sides);
}

}  // namespace mortise::contact
