// Floaters of a copied state, read back into poses.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <shared/floaters.h>

#include <spindrift/sim/water_sim.h>

namespace spindrift::study {

struct FloaterPose {
  double x_m, y_m, z_m;  ///< of the centre of mass
  double velocity_x_mps, velocity_y_mps, velocity_z_mps;
  double up_x, up_y, up_z;  ///< where its own y axis points
  double spin_radps;
  double dent;       ///< share of its displacement at rest with which it presses on the water
  double ballast_m;  ///< centre of mass above the middle of the shape
  double age_s;
  [[nodiscard]] double speed_mps() const { return std::hypot(velocity_x_mps, velocity_y_mps, velocity_z_mps); }
  [[nodiscard]] double tilt_deg() const { return std::acos(std::min(up_y, 1.0)) * 180.0 / std::numbers::pi; }
  /// Of the middle of its shape.
  [[nodiscard]] double middle_m() const { return y_m - ballast_m * up_y; }
};

/// Returns those that are there, in the order of their slots.
[[nodiscard]] inline std::vector<FloaterPose> floaterPoses(const sim::StateCopy& state) {
  std::vector<FloaterPose> out;
  for (std::size_t at = 0; at < state.floaters.size(); at += FLOATER_TEXELS * 4) {
    const float* s = &state.floaters[at];
    if (s[3] < 0) continue;
    const double x = s[4], y = s[5], z = s[6], w = s[7];
    out.push_back({s[0], s[1], s[2], s[8], s[9], s[10], 2 * (x * y - w * z), 1 - 2 * (x * x + z * z),
                   2 * (y * z + w * x), std::hypot(s[12], s[13], s[14]), s[15], s[21], s[3]});
  }
  return out;
}

}  // namespace spindrift::study
