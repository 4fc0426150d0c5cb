#include "feti/options.hpp"

namespace mortise::feti {

void describe(deck::Description<Options>& d)
{
  d.help("The subdomains' solver.");
  d.key("factorization", &Options::factorization,
        "Direct solver of the subdomains: cholmod (supernodal Cholesky) or klu2 (slow, for comparison).")
      .one_of({"cholmod", "klu2"});
  d.key("preconditioner", &Options::preconditioner,
        "Of face_newton: none, lumped (the surface block of the stiffness matrix), or dirichlet (its Schur complement; fewer "
        "products, a second factorization).")
      .one_of({"none", "lumped", "dirichlet"});
}

}  // namespace mortise::feti
