#include "model/subdomains.hpp"

#include "partition/decompose.hpp"
#include "partition/skins.hpp"
#include "partition/whole_bodies.hpp"
#include "qp/solver.hpp"

namespace mortise::model {

partition::Decomposition make_subdomains(const Deck& deck, const Context& context)
{
  auto decomposition = partition::decompose(deck.mesh, deck.decomposition, deck.dimension(), context);
  if (qp::solver_kind(deck.solver.programme.algorithm).whole_bodies)
    decomposition = partition::whole_bodies(decomposition, context.comm);
  const auto on_surface = bodies_of_boundary_elements(deck, decomposition.catalogue);
  return partition::skins(std::move(decomposition), on_surface, deck.output.asks_inside(), context.comm);
}

}  // namespace mortise::model
