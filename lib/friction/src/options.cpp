#include "friction/options.hpp"

namespace mortise::friction {

void describe(deck::Description<Options>& d)
{
  d.help("The fixed point of Coulomb friction over Tresca problems.");
  d.key("tolerance", &Options::tolerance, "Relative change of the slip bounds at which it stops.").positive().below(1);
  d.key("max_steps", &Options::max_steps, "Tresca problems at most.").at_least(1);
}

}  // namespace mortise::friction
