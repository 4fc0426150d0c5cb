#include "feti/options.hpp"

#include <fmt/format.h>

#include <vector>

#include "feti/direct_solver.hpp"
#include "feti/preconditioner_kind.hpp"

namespace mortise::feti {

void describe(deck::Description<Options>& d)
{
  d.help("The subdomains' solver.");
  d.key("factorization", &Options::factorization,
        "Direct solver of the subdomains: cholmod (supernodal Cholesky); for comparison cholmod_plain (with CHOLMOD's own "
        "solution) and klu2 (slow).")
      .one_of(DirectSolver::names());
  d.key("factor_precision", &Options::factor_precision,
        "Of the factors of cholmod: double; single, in half of the memory, where a solution with it differs by less than 1e-5 in "
        "the energy norm (displacements, reactions and direct solutions are refined in double precision; not for a tolerance "
        "below 1e-4, nor with temperature changes); auto: single where the tolerance is auto and factors do not fit in a cache.")
      .one_of({"auto", "double", "single"});
  const auto kinds = preconditioners();
  std::vector<std::string> names;
  std::string help = "Of face_newton: ";
  for (const auto& kind : kinds) {
    help += names.empty() ? "" : names.size() + 1 < kinds.size() ? ", " : ", or ";
    help += kind.help.empty() ? std::string(kind.name) : fmt::format("{} ({})", kind.name, kind.help);
    names.emplace_back(kind.name);
  }
  d.key("preconditioner", &Options::preconditioner, help + ".").one_of(names);
}

}  // namespace mortise::feti
