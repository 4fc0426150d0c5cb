#include "feti/options.hpp"

namespace mortise::feti {

void describe(deck::Description<Options>& d)
{
  d.help("The subdomains' solver.");
  d.key("factorization", &Options::factorization,
        "Direct solver of the subdomains: cholmod (supernodal Cholesky) or klu2 (slow, for comparison).")
      .one_of({"cholmod", "klu2"});
}

}  // namespace mortise::feti
