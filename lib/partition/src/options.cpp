#include "partition/options.hpp"

#include <fmt/format.h>

#include "deck/cases.hpp"

namespace mortise::partition {

namespace {

constexpr int largest_cluster = 500;

}  // namespace

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
  d.key("subdomains_per_cluster", &Options::subdomains_per_cluster,
        "About how many neighbouring subdomains of a body share one kernel (hybrid TFETI); 1, TFETI, is for up to some 2000 "
        "subdomains; "
        "with more let some 500 to 1000 clusters be left.")
      .at_least(1);
  d.rule(deck::when(deck::given({"subdomains"}), deck::none_given({"unknowns_per_subdomain"})));
  d.rule(deck::when(deck::given({"counts"}), deck::given_as("method", {{"const", "grid"}})));
  d.check([](const Options& options, const std::string& path, deck::Document& document) {
    if (options.subdomains && options.unknowns_per_subdomain)
      document.error(deck::join(path, "subdomains"), "is given beside unknowns_per_subdomain; remove one of them");
    if (options.subdomains_per_cluster > largest_cluster)
      document.error(deck::join(path, "subdomains_per_cluster"),
                     fmt::format("expected at most {}, found {}: what joins the subdomains of a cluster is factorized dense",
                                 largest_cluster, options.subdomains_per_cluster));
  });
}

}  // namespace mortise::partition
