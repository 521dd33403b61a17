// Standing modes of the wave, and their measured frequency and decay.
#pragma once

#include <functional>
#include <vector>

#include <spindrift/sim/water_sim.h>

namespace spindrift::study {

/// A square of linear, undamped water with one wave step per tick at Courant number `courant`.
core::Scene waveScene(std::uint32_t resolution_count, double side_m, double depth_m, double courant,
                      core::Stencil stencil, core::WaveBoundary sides);

/// A square of linear, undamped water whose waves disperse, with one wave step per tick.
core::Scene dispersiveScene(std::uint32_t resolution_count, double cell_m, double depth_m, core::WaveBoundary sides,
                            double tick_rate_hz = 60.0);

/// Sets the surface to eta(x, z) [m], x and z counted from the corner, without flow: the state half a step after a
/// moment of rest.
void setSurface(sim::WaterSim& water, const std::function<double(double x_m, double z_m)>& eta_m);

/// Returns the amplitude of a mode after each of `steps` ticks: <eta, mode> / <mode, mode>. Errors: those of the
/// device.
core::Result<std::vector<double>> amplitudes(sim::WaterSim& water, const std::function<double(double, double)>& mode,
                                             int steps);

/// A series a_n with a_{n+1} - b a_n + r a_{n-1} = 0: b and r from least squares; r = 1 if `undamped`.
struct Recurrence {
  double b = 0.0;
  double r = 1.0;
  /// Frequency omega [rad/s] and decay [1/s] of exp(-decay t) cos(omega t).
  [[nodiscard]] double omega_radps(double dt_s) const;
  [[nodiscard]] double decayRate_ps(double dt_s) const;
};
Recurrence fitRecurrence(const std::vector<double>& series, bool undamped);

}  // namespace spindrift::study
