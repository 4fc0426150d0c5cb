#include "analysis/approach.hpp"

#include <algorithm>
#include <climits>
#include <new>

#include "analysis/assembly.hpp"
#include "analysis/effort.hpp"
#include "partition/options.hpp"
#include "partition/smaller_subdomains.hpp"
#include "partition/whole_bodies.hpp"
#include "qp/limits.hpp"
#include "qp/solver.hpp"

namespace mortise::analysis {

namespace {

constexpr int large = 4;  // times as many unknowns as usual: subdomains that may be worth cutting

int usual_unknowns(const model::Deck& deck)
{
  return deck.axisymmetric() ? partition::usual_size_of_rings : partition::usual_size;
}

// Whether there are subdomains that can be cut, much larger than usual. Collective.
bool has_large_subdomains(const Assembly& assembly, const Communicator& comm)
{
  const auto& decomposition = assembly.decomposition();
  if (decomposition.clustered()) return false;
  double largest = 0;
  for (const auto& subdomain : decomposition.subdomains)
    if (!subdomain.skin)
      largest = std::max(largest, decomposition.catalogue.dimension * static_cast<double>(subdomain.mesh.node_count()));
  return comm.max(largest) > large * usual_unknowns(assembly.deck());
}

// Whether some body but those of boundary elements is cut. Collective.
bool cuts_bodies(const Assembly& assembly, const Communicator& comm)
{
  std::vector<double> pieces(assembly.decomposition().catalogue.bodies.size(), 0.0);
  for (const auto& subdomain : assembly.decomposition().subdomains)
    if (!subdomain.skin) pieces[static_cast<std::size_t>(subdomain.body)] += 1;
  comm.sum_in_place(pieces);
  return std::ranges::any_of(pieces, [](double count) { return count > 1; });
}

}  // namespace

Outcome failed(const Approach& approach, int spent, const Communicator& comm)
{
  const Outcome outcome{.status = {}, .spent = spent, .error = std::current_exception()};
  try {
    throw;
  } catch (const Error& error) {
    if (approach.takes_bodies_whole() && (error.status() == ExitStatus::bad_input ||
                                          error.status() == ExitStatus::not_converged || error.cause() == Error::Cause::memory))
      return outcome;
    throw;
  } catch (const std::bad_alloc&) {  // the other ranks would know nothing of it
    if (approach.takes_bodies_whole() && comm.size() == 1) return outcome;
    throw;
  }
}

Approach with_patience(Approach approach, const Assembly& assembly, const constraint::Constraints& constraints,
                       const Communicator& comm)
{
  using Limits = qp::limits::Automatic;
  const auto effort = [&] { return effort_of_direct(assembly, constraints, comm); };
  if (approach.kind == Approach::Kind::direct_instead)
    approach.patience = Limits::of_check;
  else if (approach.kind == Approach::Kind::whole_bodies)
    approach.patience = comm.any(feti::any_slender(assembly.system().clusters.subdomains()))
                            ? qp::Patience(Limits::on_slender_bodies)
                            : qp::Patience(Limits::on_whole_bodies, Limits::near_on_whole_bodies);
  else if (approach.algorithm == qp::Options::automatic) {
    const auto of_direct = effort();
    approach.patience = patience_with_products(of_direct, comm);
    if (approach.patience && of_direct.seconds > Limits::long_direct && cuts_bodies(assembly, comm))
      approach.next = Approach::Kind::whole_bodies;
    // All that comes before a direct solution together may cost as much as that, and little more. How near the end is, is known
    // where a residual tells.
    if (approach.kind == Approach::Kind::smaller_subdomains && approach.patience) {
      auto& [products, near] = *approach.patience;
      products -= approach.spent;
      if (products < Limits::on_smaller_ones && !assembly.deck().solver.programme.tolerance.value) near = 0;
      products = std::max(products, Limits::on_smaller_ones);
    }
    if (approach.kind == Approach::Kind::as_asked && approach.patience.value_or(INT_MAX).products > Limits::on_large_ones &&
        has_large_subdomains(assembly, comm)) {
      approach.patience = Limits::on_large_ones;
      approach.next = Approach::Kind::smaller_subdomains;
    }
  } else if (qp::solver_kind(approach.algorithm).whole_bodies)
    require_room_for_direct(effort(), comm);
  return approach;
}

namespace {

// Also where the attempt throws before it solves anything.
Outcome attempt_without_fault(const Attempt& attempt, const partition::Decomposition& bodies, const Approach& approach,
                              const Communicator& comm)
{
  try {
    return attempt(bodies, approach);
  } catch (...) {
    return failed(approach, approach.spent, comm);
  }
}

// Of a direct solution. Throws its error where the run was resumed and the record is of another model.
const char* why_it_failed(const Outcome& outcome, bool resumed)
{
  constexpr const char* no_room = "finds no room in memory";
  try {
    if (outcome.error) std::rethrow_exception(outcome.error);
  } catch (const Error& error) {
    if (resumed && error.status() == ExitStatus::bad_input) throw;
    if (error.cause() == Error::Cause::memory) return no_room;
  } catch (const std::bad_alloc&) {
    return no_room;
  }
  return "does not converge, or rounding spoils it";
}

}  // namespace

ExitStatus try_approaches(const model::Deck& deck, const partition::Decomposition& as_cut, const Attempt& attempt,
                          const Context& context, const std::optional<Approach>& resumed)
{
  using Kind = Approach::Kind;
  auto& [comm, log, timers] = context;
  const auto& asked = deck.solver.programme.algorithm;
  const std::string with_products(qp::solvers().front().name), direct(qp::solver_of_whole_bodies().name);
  Approach approach = resumed.value_or(Approach{});
  partition::Decomposition smaller;
  if (approach.kind == Kind::as_asked) {
    approach.algorithm = asked;
    const auto outcome = attempt(as_cut, approach);
    if (outcome.status) return *outcome.status;
    approach.spent = outcome.spent;
    approach.contact = outcome.contact;
    approach.next = outcome.next;
    approach.smaller = outcome.next == Kind::smaller_subdomains;
  }
  if (approach.smaller) {
    const int pieces = usual_unknowns(deck) / 2;  // what is slender wants them small
    if (approach.kind == Kind::as_asked)
      log.line("  {} products with F, and no end near: subdomains are large, and are cut into pieces of some {} unknowns",
               approach.spent, pieces);
    smaller = partition::smaller_subdomains(as_cut, pieces, comm);
  }
  if (approach.smaller && (approach.kind == Kind::as_asked || approach.kind == Kind::smaller_subdomains)) {
    approach = {Kind::smaller_subdomains, asked, {}, approach.spent, Kind::direct_instead, true};
    const auto outcome = attempt(smaller, approach);
    if (outcome.status) return *outcome.status;
    approach.spent = outcome.spent;
    approach.contact = outcome.contact;
    approach.next = outcome.next;
  }
  const auto& cut = approach.smaller ? smaller : as_cut;
  if (approach.kind != Kind::products_to_the_end) {
    const auto bodies = partition::whole_bodies(cut, comm);
    const auto no_end = [&](const char* next) { log.line("  {} products with F, and no end near: {}", approach.spent, next); };
    if (approach.kind == Kind::whole_bodies || (approach.kind != Kind::direct_instead && approach.next == Kind::whole_bodies)) {
      if (approach.kind != Kind::whole_bodies) no_end("every body is taken whole");
      approach = {Kind::whole_bodies, asked, {}, approach.spent, Kind::direct_instead, approach.smaller, approach.contact};
      const auto outcome = attempt_without_fault(attempt, bodies, approach, comm);
      if (outcome.status) return *outcome.status;
      approach.spent = outcome.spent;
    }
    if (approach.kind != Kind::direct_instead) no_end("a direct solution instead, with every body whole");
    approach = {Kind::direct_instead, direct, {}, approach.spent, Kind::direct_instead, approach.smaller, approach.contact};
    const auto outcome = attempt_without_fault(attempt, bodies, approach, comm);
    if (outcome.status) return *outcome.status;
    log.end_progress();
    log.line("  the direct solution {}: back to products with F", why_it_failed(outcome, resumed.has_value()));
    approach.spent = outcome.spent;
  }
  approach = {Kind::products_to_the_end, with_products, {}, approach.spent, Kind::direct_instead, approach.smaller};
  return attempt(cut, approach).status.value();
}

}  // namespace mortise::analysis
