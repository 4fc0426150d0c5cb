// Mortar contact: integrals over what both sides have in common, and dual functions. Over an obstacle all of a face or nothing.
#include <algorithm>

#include "rows/discretization.hpp"

namespace mortise::contact {

namespace {

class Mortar : public Discretization {
 public:
  explicit Mortar(const TwoSides& sides)
      : Discretization(sides),
        integrator_(sides.secondary, sides.surface_nodes, sides.primary, sides.primary_nodes, sides.tree, sides.sight,
                    sides.reach, sides.corners, sides.nearest, sides.bonded)
  {
  }

  void add_face(std::size_t face, bool in_facets) override
  {
    auto& faces = sides_.faces;
    in_facets = in_facets || (sides_.mesh_gaps && sides_.rays.nearest_within(face));
    if (!sides_.obstacle) return faces.add(face, integrator_.integrate(face, in_facets));
    faces.add(face, integrator_.integrate_whole(face, in_facets));
    if (!meets_all(face))
      for (const std::size_t i : faces.pieces(face)) faces.piece(i).covered.setZero();
  }

  Cover cover(std::size_t face) override
  {
    if (!sides_.obstacle) return integrator_.cover(face);
    return meets_all(face) ? Cover{1, 0} : Cover{};
  }

  void make_functions(std::span<const char> kept) override
  {
    auto& faces = sides_.faces;
    for (const std::size_t f : faces.near())
      for (const std::size_t i : faces.pieces(f)) {
        auto piece = faces.piece(i);
        Few<char, most_functions> here;
        for (Eigen::Index k = 0; k < piece.covered.size(); ++k) here.push_back(kept[faces.place_of(f, piece, k)]);
        make_dual(piece, here);
      }
  }

  void add_terms(const CutFaces::Function& function, std::vector<Term>& terms) override
  {
    const auto nodes = sides_.secondary.faces[function.face];
    const auto piece = sides_.faces.piece(function.piece);
    const auto add = [&](Local node, bool on_primary, double value) {
      if (value != 0) terms.push_back({node, on_primary, value});
    };
    for (std::size_t j = 0; j < nodes.size(); ++j) add(nodes[j], false, piece.mass(function.k, static_cast<Eigen::Index>(j)));
    for (std::size_t j = 0; j < piece.nodes.size(); ++j)
      add(piece.nodes[j], true, piece.opposite(function.k, static_cast<Eigen::Index>(j)));
  }

  double rise(const CutFaces::Function& function) override { return sides_.faces.piece(function.piece).rise[function.k]; }

 private:
  bool meets_all(std::size_t face)
  {
    const auto surface_nodes = sides_.faces.surface_nodes_of(face);
    return std::all_of(surface_nodes.begin(), surface_nodes.end(),
                       [&](Local p) { return sides_.rays.meets(static_cast<std::size_t>(p)); });
  }

  Integrator integrator_;
};

}  // namespace

std::unique_ptr<Discretization> make_mortar(const TwoSides& sides)
{
  return std::make_unique<Mortar>(sides);
}

}  // namespace mortise::contact
