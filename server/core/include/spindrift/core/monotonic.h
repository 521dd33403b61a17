// The server's clock as clients know it: seconds that only grow, from an origin that means nothing.
#pragma once

#include <chrono>

namespace spindrift::core {

inline double monotonic_s(std::chrono::steady_clock::time_point now = std::chrono::steady_clock::now()) {
  return std::chrono::duration<double>(now.time_since_epoch()).count();
}

}  // namespace spindrift::core
