// A boat on a straight track, and the head of its pressure on the water.
#pragma once

#include <cstddef>
#include <vector>

#include <spindrift/core/result.h>
#include <spindrift/sim/water_sim.h>

namespace spindrift::study {

/// What the pressure of a hull depends on, as in shaders/bodies/boat.glsl:hullHead and shaders/shared/boats.h.
struct HullState {
  double x_m = 0.0, z_m = 0.0;  ///< counted from the corner of the water
  double heading_rad = 0.0;
  double age_s = 0.0;
  double length_m = 0.0, beam_m = 0.0, draught_m = 0.0;
  double aloft = 0.0;
};

/// Returns the first boat of a state.
[[nodiscard]] HullState hullOf(const sim::StateCopy& state, double side_m);

/// Height of water that the hull displaces at each cell [m], n x n, x fastest, on water with periodic sides. The same
/// shape as on the device: that is the load of which the waves are compared.
[[nodiscard]] std::vector<double> hullHead(const HullState& hull, std::size_t n, double side_m);

/// Runs one tick and then sets the first boat's speed along +x and holds it upright and submerged, whatever drives,
/// resists and lifts it. Returns the state after the tick. Errors: those of the device.
[[nodiscard]] core::Result<sim::StateCopy> tickAtSpeed(sim::WaterSim& water, double speed_mps);

}  // namespace spindrift::study
