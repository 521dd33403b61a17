// The ramp with which everything begins and ends.
#pragma once

#include <algorithm>

namespace spindrift::sim {

/// Returns 0 before the pulse, 1 after it, and a smooth ramp between (smoothstep). `phase`: time since the start over
/// the duration.
inline double pulse(double phase) {
  const double t = std::clamp(phase, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

}  // namespace spindrift::sim
