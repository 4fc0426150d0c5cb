#include "constraint/options.hpp"

namespace mortise::constraint {

void describe(deck::Description<SupportOptions>& d)
{
  d.help("Prescribed displacements of a boundary.");
  d.key("boundary", &SupportOptions::boundary, "Boundary that is held.").required();
  d.key("name", &SupportOptions::name, "To refer to it; the boundary if not given.");
  d.key("displacement", &SupportOptions::displacement, "Components by axis; one that is not named is free.").required();
}

}  // namespace mortise::constraint
