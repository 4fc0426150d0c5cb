#include "analysis/effort.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/memory.hpp"
#include "base/error.hpp"
#include "base/timer.hpp"
#include "feti/explicit_problem.hpp"
#include "feti/sparse_problem.hpp"
#include "partition/interface_elimination.hpp"

namespace mortise::analysis {

namespace {

// Measured on one core of 2025: dense algebra on matrices is bound by arithmetic, a product with F by memory.
constexpr double dense_rate = 30e9, sparse_rate = 1.5e9;  // operations a second
constexpr double set_up = 10;                             // products that assembling and cutting anew take

// The rows between subdomains of boundary elements, which stay as they are cut. On this rank, those of a node shared out over its
// copies.
double rows_between_skins(const partition::Decomposition& decomposition, const partition::Interface& interface)
{
  double rows = 0;
  for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
    if (!decomposition.subdomains[s].skin) continue;
    for (std::size_t i = 0; i < interface.nodes[s].size(); ++i) {
      const auto copies = static_cast<double>(interface.copies[s][i].size());
      rows += decomposition.catalogue.dimension * (copies - 1) / copies;
    }
  }
  return rows;
}

// Of a body with n unknowns whose subdomains have factors of `inside` entries: their factors and that of the interface, or what
// the law of nested dissection makes of them where that is less. Each column of a factor has the average height, twice over.
partition::FactorSize whole_factor(double n, double inside, double by_law, const partition::FactorSize& interface)
{
  const partition::FactorSize joined{inside + interface.entries, 2 * inside * inside / n + interface.operations};
  return by_law < joined.entries ? partition::FactorSize{by_law, 2 * by_law * by_law / n} : joined;
}

// How many rows of B a direct solution has to do with, of all ranks.
struct CountedRows {
  double all = 0;           // with bodies taken whole
  double closing = 0;       // of contacts that may open
  double prescribed = 0;    // by supports that stay rows
  bool eliminated = false;  // the other supports: with the stiffness, by factors of their own
  bool rigid = true;        // nothing gives way
};

// Collective.
CountedRows count_rows(const Assembly& assembly, const constraint::Constraints& constraints, const Communicator& comm)
{
  const auto& contacts = constraints.contacts;
  CountedRows rows;
  for (std::size_t i = 0; i < contacts.nodes.size(); ++i)
    if (!contacts.bonded[i]) rows.closing += 1 + static_cast<double>(contacts.nodes[i].tangents.size());
  rows.closing = comm.sum(rows.closing);
  // Many supports along axes are eliminated with the stiffness, by factors of their own.
  const auto coupled = std::count_if(constraints.prescribed.begin(), constraints.prescribed.end(),
                                     [](const constraint::PrescribedDof& dof) { return dof.unknown; });
  const Global along_axes = comm.sum(static_cast<long long>(constraints.prescribed.size()) - coupled);
  rows.eliminated = along_axes > feti::few_supports;
  rows.prescribed =
      static_cast<double>(comm.sum(static_cast<long long>(constraints.skew_supports.size() + constraints.mean_motions.size() +
                                                          constraints.springs.own.size()) +
                                   coupled) +
                          (rows.eliminated ? 0 : along_axes));
  rows.all = rows.prescribed + static_cast<double>(comm.sum(static_cast<long long>(contacts.rows.size()))) +
             comm.sum(rows_between_skins(assembly.decomposition(), assembly.interface()));
  rows.rigid = !comm.any(!constraints.springs.own.empty() || !constraints.mean_motions.empty());
  return rows;
}

// The factors of whole bodies, of all ranks.
struct WholeFactors {
  double entries = 0, operations = 0;
  double unknowns = 0, weighted = 0;  // of the bodies; the sum of entries times unknowns
  double read_by_product = 0;         // entries of the factors of the subdomains that there are, which a product with F reads
};

// Collective.
WholeFactors foresee_factors(const Assembly& assembly, const Communicator& comm)
{
  const auto& decomposition = assembly.decomposition();
  const int dimension = decomposition.catalogue.dimension;
  const auto& subdomains = assembly.system().clusters.subdomains();
  const auto bodies = decomposition.catalogue.bodies.size();
  // Of each body: its unknowns, and of the factors of its subdomains what they hold and what the law says of them.
  std::vector<double> sums(3 * bodies, 0.0);
  for (std::size_t s = 0; s < subdomains.size(); ++s) {
    const auto b = 3 * static_cast<std::size_t>(decomposition.subdomains[s].body);
    const double n = subdomains[s]->size();
    sums[b] += n;
    sums[b + 1] += static_cast<double>(subdomains[s]->original().factor_bytes()) / sizeof(double);
    sums[b + 2] += of_nested_dissection(n, dimension);
  }
  comm.sum_in_place(sums);
  const auto interfaces = partition::interface_elimination(decomposition, assembly.interface(), comm);
  WholeFactors factors;
  double inside = 0, law = 0;
  for (std::size_t b = 0; b < bodies; ++b) {
    const double n = std::max(sums[3 * b], 1.0), own = sums[3 * b + 1], own_law = sums[3 * b + 2];
    const auto whole = whole_factor(n, own, own / std::max(own_law, 1.0) * of_nested_dissection(n, dimension), interfaces[b]);
    inside += own;
    law += own_law;
    factors.entries += whole.entries;
    factors.operations += whole.operations;
    factors.weighted += whole.entries * n;
    factors.unknowns += n;
  }
  factors.read_by_product = std::max(inside, law);
  return factors;
}

}  // namespace

DirectEffort effort_of_direct(const Assembly& assembly, const constraint::Constraints& constraints, const Communicator& comm)
{
  const auto rows = count_rows(assembly, constraints, comm);
  const auto factors = foresee_factors(assembly, comm);
  const double free = rows.all - rows.closing;
  // With sparse matrices nothing grows with the number of rows; see feti::SparseProblem.
  const double dense = feti::work_of_dense_solution(free, rows.closing),
               sparse = feti::work_of_sparse_solution(factors.entries, factors.unknowns);
  DirectEffort effort;
  effort.multipliers = static_cast<Global>(rows.all);
  effort.sparse = rows.rigid && rows.all >= feti::many_rows && sparse < feti::worth_of_sparse * dense;
  if (effort.sparse) {
    effort.seconds = (factors.operations + sparse) / dense_rate;
    effort.bytes = sizeof(double) * 6 * factors.entries;
  } else {
    const double columns = rows.prescribed + 2 * (rows.all - rows.prescribed);
    const double work =
        (rows.eliminated ? 2 : 1) * factors.operations + 4 * columns * factors.weighted / factors.unknowns + dense;
    effort.seconds = work / dense_rate;
    effort.bytes = sizeof(double) * ((rows.eliminated ? 2.5 : 1.5) * factors.entries + 4 * rows.all * rows.all);
  }
  effort.products = set_up + effort.seconds * sparse_rate / (4 * factors.read_by_product);
  return effort;
}

std::optional<qp::Patience> patience_with_products(const DirectEffort& effort, const Communicator& comm)
{
  using Limits = qp::limits::Automatic;
  const double room = -comm.max(-Limits::part_of_memory * available_memory());
  if (!(effort.bytes < room) || effort.too_many()) return {};
  const double most = effort.seconds < Limits::a_moment
                          ? std::min(Limits::shortest + Limits::a_second * effort.seconds, Limits::longest)
                          : std::numeric_limits<int>::max();
  const double near =
      effort.seconds < Limits::at_once ? 0 : std::min(Limits::part_of_rest * effort.products, Limits::most_of_rest);
  return qp::Patience(static_cast<int>(std::clamp(effort.products, Limits::shortest, most)), static_cast<int>(near));
}

void require_room_for_direct(const DirectEffort& effort, const Communicator& comm)
{
  const double room = -comm.max(-available_memory());
  if (effort.bytes < room && !effort.too_many()) return;
  throw Error(
      ExitStatus::machine,
      fmt::format("not enough memory: `solver.algorithm: direct` makes matrices of {} rows, about {:.1f} GB; there is room for "
                  "{:.1f} GB and {} rows. `auto` and `face_newton` need no such matrices",
                  effort.multipliers, effort.bytes / 1e9, room / 1e9, qp::limits::Automatic::most_multipliers));
}

}  // namespace mortise::analysis
