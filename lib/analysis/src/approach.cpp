#include "analysis/approach.hpp"

#include <new>

#include "analysis/assembly.hpp"
#include "analysis/effort.hpp"
#include "partition/whole_bodies.hpp"

namespace mortise::analysis {

namespace {

constexpr int products_of_check = 40;  // that a direct solution is one

// A body of several skins, which cannot be made whole for a direct solution; empty if there is none. Collective.
std::string cut_skin(const partition::Decomposition& decomposition, const Communicator& comm)
{
  std::vector<double> skins(decomposition.catalogue.bodies.size(), 0.0);
  for (const auto& subdomain : decomposition.subdomains)
    if (subdomain.skin) skins[static_cast<std::size_t>(subdomain.body)] += 1;
  comm.sum_in_place(skins);
  for (std::size_t b = 0; b < skins.size(); ++b)
    if (skins[b] > 1) return decomposition.catalogue.bodies[b].name;
  return {};
}

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
  const auto cut = cut_skin(assembly.decomposition(), comm);
  if (!cut.empty() && approach.algorithm == "direct")
    throw Error(ExitStatus::bad_input,
                "body \"" + cut +
                    "\" is made of boundary elements and cut into several subdomains: `solver.algorithm: direct` wants " +
                    "it whole (decomposition.subdomains), `auto` and `face_newton` do not");
  if (!cut.empty()) return approach;
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
