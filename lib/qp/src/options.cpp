#include "qp/options.hpp"

namespace mortise::qp {

void describe(deck::Description<Options>& d)
{
  d.help("How the quadratic programme in the multipliers is solved.");
  d.key("algorithm", &Options::algorithm,
        "face_newton: an active set method on exactly projected points; smalse: SMALSE-M with MPGP inside, the paper's; direct: "
        "every "
        "body one subdomain, the dual operator a matrix, contact solved exactly; auto: face_newton, and direct once that costs "
        "less "
        "than what is likely to come.")
      .one_of({"auto", "face_newton", "smalse", "direct"});
  d.key("tolerance", &Options::tolerance,
        "Relative: the reduced projected gradient and the equality residual over ||P d||. auto: stop when the algebraic error is "
        "a "
        "tenth of the estimated discretization error, both in the energy norm.")
      .positive()
      .below(1);
  d.key("max_multiplications", &Options::max_multiplications,
        "Products with the dual operator in the whole run. auto: each load step goes on until nothing has become better over "
        "2,500 products, to 10,000 at most; smalse: to 10,000.")
      .at_least(1);
}

}  // namespace mortise::qp
