// What a solve leaves open: contact nodes of which it is not known whether they press or slip, and those at which it made no
// progress. Both are called points.
#pragma once

#include <string>
#include <vector>

#include "base/types.hpp"

namespace mortise::friction {

/// The points of one contact whose state is not known.
struct Undecided {
  struct Band {
    long long points = 0;
    int cells = 0;  ///< how wide the band is at its widest place, from decided points to decided points
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
  int turns = 0, of = 0;        ///< its state changed `turns` times over the last `of` steps
};

}  // namespace mortise::friction
