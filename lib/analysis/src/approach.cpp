#include "analysis/approach.hpp"

#include <new>

#include "analysis/assembly.hpp"
#include "analysis/effort.hpp"
#include "partition/whole_bodies.hpp"

namespace mortise::analysis {

namespace {

constexpr int products_of_check = 40;  // that a direct solution is one

}  // namespace

bool is_tried_again(const Approach& approach, const Error& error)
{
  return approach.kind == Approach::Kind::direct_instead &&
         (error.status() == ExitStatus::bad_input || error.status() == ExitStatus::not_converged ||
          error.cause() == Error::Cause::memory);
}

Approach with_patience(Approach approach, const Assembly& assembly, const constraint::Constraints& constraints,
                       const Communicator& comm)
{
  const auto effort = [&] { return effort_of_direct(assembly.decomposition(), assembly.system(), constraints, comm); };
  if (approach.kind == Approach::Kind::direct_instead)
    approach.patience = products_of_check;
  else if (approach.algorithm == "auto")
    approach.patience = patience_with_products(effort(), comm);
  else if (approach.algorithm == "direct")
    require_room_for_direct(effort(), comm);
  return approach;
}

ExitStatus try_approaches(const model::Deck& deck, const partition::Decomposition& as_cut, const Attempt& attempt,
                          const Context& context)
{
  auto& [comm, log, timers] = context;
  Approach approach{Approach::Kind::as_asked, deck.solver.programme.algorithm};
  if (const auto status = attempt(as_cut, approach)) return *status;
  log.line("  {} products with F, and no end near: a direct solution, with every body whole, costs as much", approach.spent);
  approach.kind = Approach::Kind::direct_instead;
  approach.algorithm = "direct";
  const char* why = "does not converge, or rounding spoils it";
  try {
    if (const auto status = attempt(partition::whole_bodies(as_cut, comm), approach)) return *status;
  } catch (const Error& error) {
    if (!is_tried_again(approach, error)) throw;
    if (error.cause() == Error::Cause::memory) why = "finds no room in memory";
  } catch (const std::bad_alloc&) {
    if (comm.size() > 1) throw;  // the other ranks know nothing of it
    why = "finds no room in memory";
  }
  log.end_progress();
  log.line("  the direct solution {}: back to products with F", why);
  approach = {Approach::Kind::products_to_the_end, "face_newton", {}, approach.spent};
  return attempt(as_cut, approach).value();
}

}  // namespace mortise::analysis
