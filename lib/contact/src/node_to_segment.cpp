// Contact of nodes with the faces opposite: each node with its part of the faces round it, whole or not at all.
#include "discretization.hpp"

namespace mortise::contact {

namespace {

class NodeToSegment : public Discretization {
 public:
  explicit NodeToSegment(const TwoSides& sides)
      : Discretization(sides),
        integrator_(sides.secondary, sides.places, sides.primary, sides.primary_nodes, sides.tree, sides.reach)
  {
  }

  // A function is taken out if one of the nodes whose values it sees meets nothing.
  void add_face(std::size_t face) override
  {
    auto& faces = sides_.faces;
    faces.add(face, integrator_.integrate_whole(face));
    auto covered = faces.piece(faces.pieces(face).front()).covered;
    const auto places = faces.surface_nodes_of(face);
    const auto& control = control_values(sides_.secondary.faces.type[face]);
    for (Eigen::Index k = 0; k < control.rows(); ++k)
      for (Eigen::Index l = 0; l < control.cols(); ++l)
        if (control(k, l) != 0 && !sides_.rays.meets(static_cast<std::size_t>(places[static_cast<std::size_t>(l)])))
          covered[k] = 0;
  }

  void make_functions(std::span<const char> /*kept*/) override {}  // they are those of the nodes

  // u_s - sum_j N_j u_j at what each node meets, weighted with the node's share of the face.
  void add_terms(const CutFaces::Function& function, std::vector<Term>& terms) override
  {
    const auto& [secondary, own_places, primary, primary_nodes, tree, faces, rays, obstacle, reach] = sides_;
    const auto places = faces.surface_nodes_of(function.face);
    const auto nodes = secondary.faces[function.face];
    const auto piece = faces.piece(function.piece);
    const auto& control = control_values(secondary.faces.type[function.face]);
    for (Eigen::Index l = 0; l < control.cols(); ++l) {
      const double weight = control(function.k, l) * piece.covered[function.k];
      if (weight == 0) continue;
      terms.push_back({nodes[static_cast<std::size_t>(l)], false, weight});
      if (obstacle) continue;
      const Opposite& opposite = rays.meet(static_cast<std::size_t>(places[static_cast<std::size_t>(l)]));
      const auto other = primary.faces[static_cast<std::size_t>(primary.face_of[opposite.facet])];
      const FaceShape shape = primary.shape_in_face(opposite.facet, opposite.hit.shape, opposite.hit.frame, Plane::Zero());
      for (std::size_t j = 0; j < other.size(); ++j)
        terms.push_back({other[j], true, -weight * shape[static_cast<Eigen::Index>(j)]});
    }
  }

  bool seams_end_at_contacts() const override { return false; }

 private:
  Integrator integrator_;
};

}  // namespace

std::unique_ptr<Discretization> make_node_to_segment(const TwoSides& sides)
{
  return std::make_unique<NodeToSegment>(sides);
}

}  // namespace mortise::contact
