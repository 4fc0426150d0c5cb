#include "analysis/assembly.hpp"

#include <algorithm>

#include "analysis/memory.hpp"
#include "base/error.hpp"
#include "base/interruption.hpp"
#include "bem/particular_solution.hpp"
#include "fem/stiffness.hpp"
#include "feti/dense_subdomain.hpp"
#include "model/indefinite.hpp"

namespace mortise::analysis {

namespace {

// Forces of a subdomain of boundary elements by the loads of its inside.
template <int D>
Eigen::VectorXd forces_of_inside(const mesh::Mesh& skin, const bem::ParticularSolution& particular,
                                 const feti::SubdomainOperator& s)
{
  const auto panels = bem::make_panels<D>(skin);
  return s.apply(particular.displacement(panels)) - particular.nodal_forces(panels);
}

// How much factors may change by being rounded to single precision, if they may be.
std::optional<double> most_rounded(const model::Model& model, const std::vector<partition::CopyOf>& copies,
                                   const Communicator& comm)
{
  constexpr double most = 1e-5;    // in the energy norm: the solver's error is hardly ever asked to be less than 1e-4
  constexpr double caches = 64e6;  // bytes in double precision, from which on factors come from memory
  constexpr double entries_in_plane = 6, entries_in_space = 16;  // of a factor, over what of_nested_dissection() says
  const auto& deck = model.deck();
  const auto& [programme, options] = deck.solver;
  const auto& decomposition = model.decomposition();
  if (options.factor_precision == "double" || options.factorization != "cholmod" || decomposition.clustered()) return {};
  // What is free to expand has no stress, and displacements as large as any: rounding is a part of these.
  if (std::ranges::any_of(deck.loads, [](const auto& load) { return load.temperature_change.has_value(); })) return {};
  if (options.factor_precision == "single") return most;
  if (programme.tolerance.value || qp::solver_kind(programme.algorithm).whole_bodies) return {};
  double sum = 0;
  for (std::size_t s = 0; s < copies.size(); ++s)
    if (copies[s].original == s && !decomposition.subdomains[s].skin)
      sum += of_nested_dissection(static_cast<double>(decomposition.subdomains[s].mesh.node_count()) * deck.dimension(),
                                  deck.dimension());
  const double entries = (deck.dimension() == 3 ? entries_in_space : entries_in_plane) * comm.sum(sum);
  if (sizeof(double) * entries < caches) return {};
  return most;
}

// Factorizes every subdomain that is not a copy of an earlier one; takes their stiffness.
feti::Subdomains factorize(const model::Model& model, const std::vector<partition::CopyOf>& copies,
                           std::vector<SparseMatrix>& stiffness,
                           const std::vector<std::shared_ptr<const feti::SubdomainOperator>>& dense,
                           std::optional<double> most_rounded)
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
    if (dense[s]) {
      subdomains.push_back(dense[s]);
      continue;
    }
    const auto& subdomain = decomposition.subdomains[s];
    const auto& points = subdomain.mesh.points;
    try {
      SparseMatrix own;  // so that it goes when it is factorized: Eigen 3.4 would copy what is moved
      own.swap(stiffness[s]);
      subdomains.push_back(std::make_shared<feti::ElasticSubdomain>(
          std::move(own), fem::rigid_motions(points, deck.kinematics), points, deck.dimension(),
          deck.solver.subdomains.factorization, most_rounded,
          deck.solver.programme.tolerance.value ? feti::inaccurate_for_residuals : feti::inaccurate));
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
  const int dimension = model.deck().dimension();
  stiffness.matrices.resize(copies.size());
  stiffness.dense.resize(copies.size());
  collectively(context.comm, [&] {
    for (std::size_t s = 0; s < copies.size(); ++s) {
      stop_if_requested();
      if (copies[s].original != s) {
        stiffness.of_nodes.push_back(stiffness.of_nodes[copies[s].original]);
        continue;
      }
      const auto& subdomain = model.decomposition().subdomains[s];
      Eigen::VectorXd diagonal;
      if (subdomain.skin) {
        stiffness.dense[s] = std::make_shared<feti::DenseSubdomain>(
            model.steklov_poincare(subdomain), fem::rigid_motions(subdomain.mesh.points, model.deck().kinematics),
            subdomain.mesh.points, dimension);
        diagonal = stiffness.dense[s]->diagonal();
      } else {
        model.stiffness(subdomain).swap(stiffness.matrices[s]);
        diagonal = stiffness.matrices[s].diagonal();
      }
      stiffness.of_nodes.push_back(feti::nodal_stiffness(diagonal, dimension));
    }
  });
  return stiffness;
}

Assembly::Assembly(const model::Model& model, const std::vector<partition::CopyOf>& copies, Stiffness stiffness,
                   const Context& context)
    : model_(model),
      copies_(copies),
      directory_(model.decomposition(), stiffness.of_nodes, context.comm),
      interface_(partition::find_interface(model.decomposition(), directory_, context.comm))
{
  const auto kinematics = model.deck().kinematics;
  const auto scope = context.timers.scope("factorization");
  const auto most = most_rounded(model, copies, context.comm);
  collectively(context.comm, [&] {
    system_.clusters =
        feti::Clusters(model.decomposition(), interface_, factorize(model, copies, stiffness.matrices, stiffness.dense, most),
                       stiffness.of_nodes, kinematics);
  });
  system_.nodal_stiffness = std::move(stiffness.of_nodes);
  system_.kinematics = kinematics;
}

std::vector<Eigen::VectorXd> Assembly::loads(const model::LoadState& state, const Communicator& comm) const
{
  auto f = model_.loads(state, comm);
  const auto constitution = model_.constitution(state);
  for (std::size_t s = 0; s < f.size(); ++s) {
    const auto& subdomain = decomposition().subdomains[s];
    if (!subdomain.skin) continue;
    const auto& deck = model_.deck();
    const bem::ParticularSolution particular(constitution[s], subdomain.mesh.points.front(), deck.kinematics);
    if (particular.is_zero()) continue;
    const auto& own = *system_.clusters.subdomains()[s];
    f[s] += deck.dimension() == 2 ? forces_of_inside<2>(subdomain.mesh, particular, own)
                                  : forces_of_inside<3>(subdomain.mesh, particular, own);
  }
  return f;
}

}  // namespace mortise::analysis
