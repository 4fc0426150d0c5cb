// When a rigid motion counts as free.
#pragma once

namespace mortise::feti {

// What rows feel (FreeMotion::resistance) of a motion that is free up to rounding.
inline constexpr double exactly_free = 1e-6;

}  // namespace mortise::feti
