// What a solve leaves open: points of which it is not known whether they press or slip, and points at which it got stuck.
#pragma once

#include <string>
#include <vector>

#include "base/types.hpp"

namespace mortise::friction {

/// Of one contact, where not everything is decided.
struct Undecided {
  struct Band {
    long long points = 0;
    int cells = 0;  ///< between decided points on both sides, at the widest place
  };
  int contact = 0;     ///< index into the deck's contacts
  Band rim;            ///< of points that may be open or closed
  Band edge_of_stick;  ///< of closed points that may stick or slip
};

/// Points of one contact at which a solve made no progress.
struct Stuck {
  int contact = 0;
  long long points = 0;
  std::string states;           ///< that they took in turns: "open/closed" or "stick/slip"; "at rest": only their forces vary
  Point place = Point::Zero();  ///< of the worst of them
  int turns = 0, of = 0;        ///< how often its state changed over the last so many steps
};

}  // namespace mortise::friction
