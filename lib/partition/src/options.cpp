#include "partition/options.hpp"

namespace mortise::partition {

void describe(deck::Description<Options>& d)
{
  d.help("How bodies are cut into subdomains.");
  d.key("method", &Options::method, "metis, or grid for blocks.").one_of({"metis", "grid"});
  d.key("unknowns_per_subdomain", &Options::unknowns_per_subdomain,
        "Aim, where nothing is said 4000, in axisymmetric models 20000; every body has at least one subdomain.")
      .at_least(10);
  d.key("subdomains", &Options::subdomains,
        "Total number, at least one a body, instead of unknowns_per_subdomain; with instances at most this, since all are cut "
        "alike.")
      .at_least(1);
  d.key("counts", &Options::counts, "For grid: subdomains along each axis of each block (of each instance of it).").at_least(0);
  d.check([](const Options& options, const std::string& path, deck::Document& document) {
    if (options.subdomains && options.unknowns_per_subdomain)
      document.error(deck::join(path, "subdomains"), "is given beside unknowns_per_subdomain; remove one of them");
  });
}

}  // namespace mortise::partition
