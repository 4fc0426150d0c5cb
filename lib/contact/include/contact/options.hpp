// The deck's section `contacts`.
#pragma once

#include <optional>
#include <string>

#include "contact/obstacle.hpp"
#include "deck/description.hpp"

namespace mortise::contact {

enum class Law { frictionless, tresca, coulomb, bonded };

/// How a bonded contact draws its two sides together; exactly one is given.
struct PreloadOptions {
  std::optional<double> force;       ///< tension of the bolt, > 0
  std::optional<double> shortening;  ///< of the bolt, at the cut
};

struct Options {
  std::string name;       ///< default: "secondary/primary"
  std::string secondary;  ///< boundary that carries the multipliers
  std::string primary;    ///< empty for an obstacle
  std::optional<Obstacle> obstacle;
  Law law = Law::frictionless;
  double friction = 0;                    ///< tresca: slip bound as a traction; coulomb: coefficient
  std::string discretization = "mortar";  ///< or "node_to_segment"
  double interference = 0;                ///< added overlap; negative opens a gap
  double search_distance = 0;  ///< surfaces farther apart than this never meet; 0: a tenth of the smaller side's extent
  std::optional<PreloadOptions> preload = {};  ///< bonded contacts alone
};

/// The keywords.
void describe(deck::Description<PreloadOptions>& d);
void describe(deck::Description<Options>& d);

}  // namespace mortise::contact
