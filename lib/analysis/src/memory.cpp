#include "analysis/memory.hpp"

#include <fmt/format.h>

#include <cmath>

#include "base/error.hpp"
#include "base/timer.hpp"
#include "fem/stiffness.hpp"
#include "feti/dense_subdomain.hpp"
#include "feti/preconditioner_kind.hpp"

namespace mortise::analysis {

namespace {

// Measured on the inputs and on regression/tables: what a run keeps besides factors and matrices.
constexpr double bytes_an_unknown = 450;         // mesh, fields, vectors of the subdomains
constexpr double bytes_a_multiplier = 1000;      // vectors of the dual space, most of them recycled directions; B, G
constexpr double dirichlet_part = 0.8;           // of a factor: the preconditioner's own
constexpr double constraints_of_subdomain = 45;  // averages that join a subdomain to others of its cluster, each a vector of it
// V, K, D and what they are made of, for each pair of unknowns at nodes, in a plane and in space.
constexpr double numbers_of_plane_operators = 8, numbers_of_boundary_operators = 16;
constexpr double bytes_an_entry = 12;  // of a sparse matrix
constexpr double margin = 0.9;         // of what is available

// Whether the preconditioner factorizes, too.
bool second_factors(const model::Deck& deck)
{
  return feti::preconditioner_kind(deck.solver.subdomains.preconditioner).factorizes;
}

// Sum over the ranks that share this rank's memory. Collective.
double sum_on_machine(double x, const Communicator& comm)
{
  MPI_Comm machine = MPI_COMM_NULL;
  MPI_Comm_split_type(comm.mpi(), MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
  const double sum = Communicator(machine).sum(x);
  MPI_Comm_free(&machine);
  return sum;
}

}  // namespace

double of_nested_dissection(double unknowns, int dimension)
{
  return dimension == 3 ? std::pow(unknowns, 4.0 / 3) : unknowns * std::log2(unknowns + 1);
}

Memory foresee_memory(const model::Model& model, const std::vector<partition::CopyOf>& copies, bool exact, const Communicator& comm)
{
  const auto& deck = model.deck();
  const auto& decomposition = model.decomposition();
  const int dimension = deck.dimension();
  const auto unknowns = [&](std::size_t s) {
    return static_cast<double>(decomposition.subdomains[s].mesh.node_count()) * dimension;
  };
  double all = 0, surfaces = 0, scaled = 0, matrices = 0, squares = 0;
  double dense = 0, making = 0;  // bytes of boundary elements, kept and for a moment
  constexpr auto none = static_cast<std::size_t>(-1);
  std::size_t largest = none;
  for (std::size_t s = 0; s < copies.size(); ++s) {
    all += unknowns(s);
    surfaces += 2 * dimension * std::pow(unknowns(s) / dimension, 1 - 1.0 / dimension) * dimension;
    if (copies[s].original != s) continue;
    if (decomposition.subdomains[s].skin) {
      dense += static_cast<double>(feti::DenseSubdomain::foreseen_bytes(static_cast<std::size_t>(unknowns(s))));
      const double numbers = dimension == 2 ? numbers_of_plane_operators : numbers_of_boundary_operators;
      making = std::max(making, sizeof(double) * numbers * unknowns(s) * unknowns(s));
      continue;
    }
    if (largest == none || unknowns(s) > unknowns(largest)) largest = s;
    scaled += of_nested_dissection(unknowns(s), dimension);
    matrices += unknowns(s);
    squares += unknowns(s) * unknowns(s);
  }
  const double times = second_factors(deck) ? 1 + dirichlet_part : 1.0;
  double others = bytes_an_unknown * all + 0.5 * bytes_a_multiplier * surfaces + dense + making;
  if (decomposition.clustered()) others += constraints_of_subdomain * sizeof(double) * matrices;
  // `sparse`: of the factors, `twice`: of the largest, of which there are two copies while it is factorized; `entries`: of K.
  const auto with = [&](double sparse, double twice, double entries) {
    const double held = others + sparse + twice + bytes_an_entry * entries;
    Memory memory;
    memory.factors = comm.sum(dense + sparse);
    memory.total = comm.sum(held + static_cast<double>(peak_memory()));
    memory.excess = comm.max(sum_on_machine(held, comm) - margin * available_memory());
    return memory;
  };
  if (!exact) {
    const double most = largest == none ? 0 : unknowns(largest);
    const auto full = with(times * sizeof(double) * squares, sizeof(double) * most * most, 0.5 * squares);
    if (full.excess <= 0) return full;
  }
  double sparse = 0, bytes = 0, entries = 0;
  collectively(comm, [&] {
    if (largest == none) return;
    const auto& subdomain = decomposition.subdomains[largest];
    const auto lower = model.stiffness(subdomain);
    bytes = static_cast<double>(feti::ElasticSubdomain::foreseen_factor_bytes(
        lower, fem::rigid_motions(subdomain.mesh.points, deck.kinematics), subdomain.mesh.points, dimension));
    sparse = times * bytes * scaled / of_nested_dissection(unknowns(largest), dimension);
    entries = static_cast<double>(lower.nonZeros()) * matrices / unknowns(largest);
  });
  return with(sparse, bytes, entries);
}

void require(const Memory& memory, const model::Model& model)
{
  const auto& deck = model.deck();
  const auto& decomposition = model.decomposition();
  if (memory.excess <= 0) return;
  const auto average = static_cast<double>(decomposition.catalogue.node_count) * deck.dimension() /
                       static_cast<double>(decomposition.subdomain_count());
  throw Error(
      ExitStatus::machine,
      fmt::format("not enough memory: the run needs about {:.1f} GB, {:.1f} GB of it for the factors of the subdomains, which is "
                  "{:.1f} GB more than there is; what helps: smaller subdomains (decomposition.unknowns_per_subdomain, now about "
                  "{:.0f}, needs less the smaller it is down to 1000){}{}, more machines, a coarser mesh",
                  memory.total / 1e9, memory.factors / 1e9, memory.excess / 1e9, average,
                  deck.mesh.surfaces.empty() ? "" : ", which takes the cells of a body: one of its surface alone is not cut",
                  second_factors(deck) ? ", solver.preconditioner: lumped" : ""),
      Error::Cause::memory);
}

}  // namespace mortise::analysis
