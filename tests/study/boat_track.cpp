#include "boat_track.h"

#include <algorithm>
#include <cmath>

#include <shared/boats.h>

#include <spindrift/study/hull_pressure.h>

#include "ticks.h"

namespace spindrift::study {

HullState hullOf(const sim::StateCopy& state, double side_m) {
  const auto& boat = state.boats;
  return {.x_m = boat[0] + side_m / 2,
          .z_m = boat[2] + side_m / 2,
          .heading_rad = boat[3],
          .age_s = boat[6],
          .length_m = boat[16],
          .beam_m = boat[17],
          .draught_m = boat[19],
          .aloft = boat[21]};
}

std::vector<double> hullHead(const HullState& hull, std::size_t n, double side_m) {
  const double cell_m = side_m / static_cast<double>(n);
  const HullPressure settled = hullPressure(
      {.length_m = hull.length_m, .beam_m = hull.beam_m, .height_m = hull.draught_m, .density_ratio = 1.0}, cell_m);
  const double share = std::min(hull.age_s / double{BOAT_SETTLING_S}, 1.0) * (1.0 - hull.aloft);
  const double c = std::cos(hull.heading_rad);
  const double s = std::sin(hull.heading_rad);
  std::vector<double> out(n * n);
  for (std::size_t z = 0; z < n; ++z) {
    const double dz_m = std::remainder((static_cast<double>(z) + 0.5) * cell_m - hull.z_m, side_m);
    for (std::size_t x = 0; x < n; ++x) {
      const double dx_m = std::remainder((static_cast<double>(x) + 0.5) * cell_m - hull.x_m, side_m);
      out[x + n * z] = share * settled.head_m(dx_m * c + dz_m * s, dz_m * c - dx_m * s);
    }
  }
  return out;
}

core::Result<sim::StateCopy> tickAtSpeed(sim::WaterSim& water, double speed_mps) {
  if (auto done = tick(water); !done) return done.error();
  sim::StateCopy state = water.copyState();
  sim::StateCopy held = state;
  // Below the surface, so that the hull never leaves the water and its pressure is steady.
  held.boats[1] = -2 * held.boats[18];
  held.boats[4] = held.boats[5] = 0.0F;  // pitch, roll
  held.boats[8] = static_cast<float>(speed_mps);
  held.boats[9] = held.boats[10] = held.boats[11] = 0.0F;  // to starboard, up, yaw
  held.boats[12] = held.boats[13] = 0.0F;                  // pitch and roll rates
  water.setState(held);
  return state;
}

}  // namespace spindrift::study
