// Models that are one of n equal sectors: what acts or moves on their common axis is that of all sectors, and lies along it.
#pragma once

#include <optional>

#include "model/deck.hpp"

namespace mortise::model {

/// The axis about which the sectors turn.
struct SectorAxis {
  Point at;
  Point along;  ///< unit

  bool has(const Point& x) const;
  Point foot(const Point& x) const { return at + along * along.dot(x - at); }
  Eigen::Matrix3d projector() const { return along * along.transpose(); }
};

/// The axis of the first contact that joins the cuts of a sector; none if the model is whole.
std::optional<SectorAxis> sector_axis(const Deck& deck);

/// Forces, motions and accelerations across the axis of sectors, which would turn with the sectors and cancel. Errors go to the
/// document.
void check_sectors(const Deck& deck, deck::Document& document);

}  // namespace mortise::model
