#include "feti/options.hpp"

namespace mortise::feti {

void describe(deck::Description<Options>& d)
{
  d.help("The subdomains' solver.");
  d.key("factorization", &Options::factorization,
        "Direct solver of the subdomains: cholmod (supernodal Cholesky); for comparison cholmod_plain (with CHOLMOD's own "
        "solution) and klu2 (slow).")
      .one_of({"cholmod", "cholmod_plain", "klu2"});
  d.key("preconditioner", &Options::preconditioner,
        "Of face_newton: none, lumped (the surface block of the stiffness matrix), or dirichlet (its Schur complement; fewer "
        "products, a second factorization).")
      .one_of({"none", "lumped", "dirichlet"});
}

}  // namespace mortise::feti
