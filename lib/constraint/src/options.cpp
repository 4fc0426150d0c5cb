#include "constraint/options.hpp"

namespace mortise::constraint {

void describe(deck::Description<SupportOptions>& d)
{
  d.help("Prescribed displacements of a boundary.");
  d.key("name", &SupportOptions::name, "For load steps; the boundary if not given.").hidden();
  d.key("boundary", &SupportOptions::boundary, "Boundary that is held.").required();
  d.key("displacement", &SupportOptions::displacement, "Components by axis; one that is not named is free.").required();
}

}  // namespace mortise::constraint
