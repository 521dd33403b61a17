// Ticks of a study. A device error ends the study: later measurements would be meaningless, and a loop that waits for
// simulated time would not end.
#pragma once

#include <concepts>

#include <spindrift/sim/water_sim.h>

namespace spindrift::study {

/// Errors: WaterSim::deviceError().
[[nodiscard]] inline core::Result<void> tick(sim::WaterSim& water) {
  water.step();
  if (const auto& error = water.deviceError()) return *error;
  return {};
}

/// `each` is called after each tick.
template <std::invocable Each>
[[nodiscard]] core::Result<void> run(sim::WaterSim& water, int tick_count, Each each) {
  for (int k = 0; k < tick_count; ++k) {
    if (auto done = tick(water); !done) return done;
    each();
  }
  return {};
}
[[nodiscard]] inline core::Result<void> run(sim::WaterSim& water, int tick_count) {
  return run(water, tick_count, [] {});
}

/// Ticks until the water's time is `time_s`.
template <std::invocable Each>
[[nodiscard]] core::Result<void> runTo(sim::WaterSim& water, double time_s, Each each) {
  while (water.time_s() < time_s - 1e-9) {
    if (auto done = tick(water); !done) return done;
    each();
  }
  return {};
}
[[nodiscard]] inline core::Result<void> runTo(sim::WaterSim& water, double time_s) {
  return runTo(water, time_s, [] {});
}

}  // namespace spindrift::study
