#include "feti/options.hpp"

#include "feti/direct_solver.hpp"

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
  d.key("preconditioner", &Options::preconditioner,
        "Of face_newton: none, lumped (the surface block of the stiffness matrix), or dirichlet (its Schur complement; fewer "
        "products, a second factorization).")
      .one_of({"none", "lumped", "dirichlet"});
}

}  // namespace mortise::feti
