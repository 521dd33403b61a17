// Boats that another program moves, and what the water does to them.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace spindrift::sim {

/// A boat that is moved from outside is the water's again after this time without moveBoat(), in simulated time.
inline constexpr double kMovedFor_s = 0.5;

/// Pose and velocities of a boat, finite; as v1::MoveBoat.
struct HullMotion {
  std::uint32_t boat_id = 0;
  double x_m = 0.0, y_m = 0.0, z_m = 0.0;  ///< of the hull's centre, half way from keel to deck
  double heading_rad = 0.0, pitch_rad = 0.0, roll_rad = 0.0;
  double velocity_x_mps = 0.0, velocity_y_mps = 0.0, velocity_z_mps = 0.0;
  double yaw_rate_radps = 0.0, pitch_rate_radps = 0.0, roll_rate_radps = 0.0;
};

/// A force along x, y, z, and its moment about the hull's centre in the axes of the hull: roll (positive lowers
/// starboard), pitch (lifts the bow), yaw (turns from +x toward +z).
struct Wrench {
  std::array<double, 3> force_n{};
  std::array<double, 3> moment_nm{};
};

/// The water's forces on a hull, mean over a tick.
struct HullForce {
  std::uint32_t boat_id = 0;
  Wrench hydrostatic{};  ///< under the rest level
  Wrench dynamic{};      ///< the rest of the pressure
  Wrench drag{};
};

struct HullForces {
  std::uint64_t tick = 0;  ///< WaterSim::tick() after that tick
  std::vector<HullForce> hulls{};
};

}  // namespace spindrift::sim
