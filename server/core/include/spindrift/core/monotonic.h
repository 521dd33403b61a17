// The server's monotonic clock, also sent to clients: seconds from an arbitrary origin.
#pragma once

#include <chrono>

namespace spindrift::core {

inline double monotonic_s(std::chrono::steady_clock::time_point now = std::chrono::steady_clock::now()) {
  return std::chrono::duration<double>(now.time_since_epoch()).count();
}

}  // namespace spindrift::core
