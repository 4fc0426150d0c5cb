#include "analysis/assembly.hpp"

#include "base/error.hpp"
#include "fem/stiffness.hpp"
#include "model/indefinite.hpp"

namespace mortise::analysis {

namespace {

// Factorizes every subdomain that is not a copy of an earlier one.
feti::Subdomains factorize(const model::Model& model, const std::vector<partition::CopyOf>& copies,
                           std::vector<SparseMatrix> stiffness)
{
  const auto& deck = model.deck();
  const auto& decomposition = model.decomposition();
  feti::Subdomains subdomains;
  for (std::size_t s = 0; s < copies.size(); ++s) {
    const auto& [original, rotation] = copies[s];
    if (original != s) {
      const auto& shared = subdomains[original];
      subdomains.push_back(rotation ? std::make_shared<feti::RotatedSubdomain>(shared, *rotation, deck.dimension()) : shared);
      continue;
    }
    const auto& subdomain = decomposition.subdomains[s];
    const auto& points = subdomain.mesh.points;
    try {
      subdomains.push_back(std::make_shared<feti::ElasticSubdomain>(std::move(stiffness[s]),
                                                                    fem::rigid_motions(points, deck.kinematics), points,
                                                                    deck.dimension(), deck.solver.subdomains.factorization));
    } catch (const Error& error) {
      if (error.status() != ExitStatus::bad_input) throw;
      const auto& body = decomposition.catalogue.bodies[static_cast<std::size_t>(subdomain.body)];
      throw Error(error.status(), model::why_indefinite(subdomain, model.materials(subdomain), body.name));
    }
  }
  return subdomains;
}

}  // namespace

Assembly::Assembly(const model::Model& model, const std::vector<partition::CopyOf>& copies, const Context& context)
    : Assembly(model, copies, assemble(model, copies, context), context)
{
}

Assembly::Stiffness Assembly::assemble(const model::Model& model, const std::vector<partition::CopyOf>& copies,
                                       const Context& context)
{
  const auto scope = context.timers.scope("assembly");
  Stiffness stiffness;
  collectively(context.comm, [&] { stiffness.matrices = model.stiffness(copies); });
  for (std::size_t s = 0; s < copies.size(); ++s)
    stiffness.of_nodes.push_back(copies[s].original == s ? feti::nodal_stiffness(stiffness.matrices[s], model.deck().dimension())
                                                         : stiffness.of_nodes[copies[s].original]);
  return stiffness;
}

Assembly::Assembly(const model::Model& model, const std::vector<partition::CopyOf>& copies, Stiffness stiffness,
                   const Context& context)
    : model_(model),
      directory_(model.decomposition(), stiffness.of_nodes, context.comm),
      interface_(partition::find_interface(model.decomposition(), directory_, context.comm))
{
  const auto kinematics = model.deck().kinematics;
  const auto scope = context.timers.scope("factorization");
  collectively(context.comm, [&] {
    system_.clusters = feti::Clusters(model.decomposition(), interface_, factorize(model, copies, std::move(stiffness.matrices)),
                                      stiffness.of_nodes, kinematics);
  });
  system_.nodal_stiffness = std::move(stiffness.of_nodes);
  system_.kinematics = kinematics;
}

}  // namespace mortise::analysis
