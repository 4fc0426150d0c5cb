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
constexpr double shortest = 15;                           // products that are tried in any case
constexpr double a_second = 16;                           // products more for each second that a direct solution takes,
constexpr double a_moment = 60;                           // where these are less,
constexpr double longest = 100;                           // up to so many
constexpr double part_of_rest = 0.25;                     // of what a direct solution takes that an end of products in sight may,
constexpr double most_of_rest = 40;                       // products at most,
constexpr double at_once = 0.1;                           // if it takes so many seconds
constexpr double part_of_memory = 0.5;                    // of what is available

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

}  // namespace

DirectEffort effort_of_direct(const Assembly& assembly, const constraint::Constraints& constraints, const Communicator& comm)
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
  const auto& contacts = constraints.contacts;
  double closing = 0;
  for (std::size_t i = 0; i < contacts.nodes.size(); ++i)
    if (!contacts.bonded[i]) closing += 1 + static_cast<double>(contacts.nodes[i].tangents.size());
  closing = comm.sum(closing);
  // Many supports along axes are eliminated with the stiffness, by factors of their own.
  const auto coupled = std::count_if(constraints.prescribed.begin(), constraints.prescribed.end(),
                                     [](const constraint::PrescribedDof& h) { return h.unknown; });
  const Global along_axes = comm.sum(static_cast<long long>(constraints.prescribed.size()) - coupled);
  const bool eliminated = along_axes > feti::few_supports;
  const auto prescribed =
      static_cast<double>(comm.sum(static_cast<long long>(constraints.skew_supports.size() + constraints.mean_motions.size() +
                                                          constraints.springs.own.size()) +
                                   coupled) +
                          (eliminated ? 0 : along_axes));
  const double all = prescribed + static_cast<double>(comm.sum(static_cast<long long>(contacts.rows.size()))) +
                     comm.sum(rows_between_skins(decomposition, assembly.interface()));
  const double free = all - closing;

  const auto interfaces = partition::interface_elimination(decomposition, assembly.interface(), comm);
  double inside = 0, law = 0, factors = 0, factorizing = 0, weighted = 0, unknowns = 0;
  for (std::size_t b = 0; b < bodies; ++b) {
    const double n = std::max(sums[3 * b], 1.0), own = sums[3 * b + 1], own_law = sums[3 * b + 2];
    const auto whole = whole_factor(n, own, own / std::max(own_law, 1.0) * of_nested_dissection(n, dimension), interfaces[b]);
    inside += own;
    law += own_law;
    factors += whole.entries;
    factorizing += whole.operations;
    weighted += whole.entries * n;
    unknowns += n;
  }
  const double entries = std::max(inside, law);  // that a product with F reads
  // With sparse matrices nothing grows with the number of rows; see feti::SparseProblem.
  const double dense = feti::work_of_dense_solution(free, closing), sparse = feti::work_of_sparse_solution(factors, unknowns);
  const bool rigid = !comm.any(!constraints.springs.own.empty() || !constraints.mean_motions.empty() ||
                               !constraints.pretension_sections.empty() || coupled > 0);
  DirectEffort effort;
  effort.multipliers = static_cast<Global>(all);
  effort.sparse = rigid && all >= feti::many_rows && sparse < feti::worth_of_sparse * dense;
  if (effort.sparse) {
    effort.seconds = (factorizing + sparse) / dense_rate;
    effort.products = set_up + effort.seconds * sparse_rate / (4 * entries);
    effort.bytes = sizeof(double) * 6 * factors;
    return effort;
  }
  const double columns = prescribed + 2 * (all - prescribed);
  const double work = (eliminated ? 2 : 1) * factorizing + 4 * columns * weighted / unknowns + dense;
  effort.seconds = work / dense_rate;
  effort.products = set_up + effort.seconds * sparse_rate / (4 * entries);
  effort.bytes = sizeof(double) * ((eliminated ? 2.5 : 1.5) * factors + 4 * all * all);
  return effort;
}

std::optional<qp::Patience> patience_with_products(const DirectEffort& effort, const Communicator& comm)
{
  const double room = -comm.max(-part_of_memory * available_memory());
  if (!(effort.bytes < room) || effort.too_many()) return {};
  const double most =
      effort.seconds < a_moment ? std::min(shortest + a_second * effort.seconds, longest) : std::numeric_limits<int>::max();
  const double near = effort.seconds < at_once ? 0 : std::min(part_of_rest * effort.products, most_of_rest);
  return qp::Patience(static_cast<int>(std::clamp(effort.products, shortest, most)), static_cast<int>(near));
}

void require_room_for_direct(const DirectEffort& effort, const Communicator& comm)
{
  const double room = -comm.max(-available_memory());
  if (effort.bytes < room && !effort.too_many()) return;
  throw Error(
      ExitStatus::machine,
      fmt::format("not enough memory: `solver.algorithm: direct` makes matrices of {} rows, about {:.1f} GB; there is room for "
                  "{:.1f} GB and {} rows. `auto` and `face_newton` need no such matrices",
                  effort.multipliers, effort.bytes / 1e9, room / 1e9, DirectEffort::most_multipliers));
}

}  // namespace mortise::analysis
