// Whether this build counts what it sends: the CMake option MORTISE_COUNT_TRAFFIC.
#pragma once

namespace mortise {

/// False: traffic() is 0 whatever is sent, and the calls of MPI are MPI's own, so that its profilers see them.
bool traffic_is_counted();

}  // namespace mortise
