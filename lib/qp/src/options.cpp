#include "qp/options.hpp"

#include <fmt/format.h>

#include "qp/solver.hpp"

namespace mortise::qp {

void describe(deck::Description<Options>& d)
{
  d.help("How the quadratic programme in the multipliers is solved.");
  std::vector<std::string> names{Options::automatic};
  std::string help;
  for (const auto& kind : solvers()) {
    names.emplace_back(kind.name);
    help += fmt::format("{}: {}; ", kind.name, kind.help);
  }
  help += "auto: face_newton, and direct once that costs less than what is likely to come.";
  d.key("algorithm", &Options::algorithm, help).one_of(names);
  d.key("tolerance", &Options::tolerance,
        "Relative: the reduced projected gradient and the equality residual over ||P d||. auto: stop when the algebraic error is "
        "a tenth of the estimated discretization error, both in the energy norm.")
      .positive()
      .below(1);
  d.key("max_multiplications", &Options::max_multiplications,
        "Products with the dual operator in the whole run. auto: each load step goes on until nothing has become better over "
        "2,500 products, to 10,000 at most; smalse: to 10,000.")
      .at_least(1);
}

}  // namespace mortise::qp
