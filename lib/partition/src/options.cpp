#include "partition/options.hpp"

namespace mortise::partition {

void describe(deck::Description<Options>& d)
{
  d.help("How bodies are cut into subdomains.");
  d.key("method", &Options::method, "metis, or grid for blocks.").one_of({"metis", "grid"});
  d.key("unknowns_per_subdomain", &Options::unknowns_per_subdomain, "Aim; every body has at least one subdomain.").at_least(10);
  d.key("subdomains", &Options::subdomains, "Total number aimed at, instead of unknowns_per_subdomain.").at_least(1).hidden();
  d.key("counts", &Options::counts, "For grid: subdomains along each axis of each block.").at_least(0);
}

}  // namespace mortise::partition
