// Sweeps of one value each: where the simulation stays finite, where its watchdog acts, and that it always recovers.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <spindrift/core/result.h>
#include <spindrift/core/scene.h>
#include <spindrift/gpu/context.h>
#include <spindrift/sim/water_sim.h>

namespace spindrift::study {

/// Result for one value of a sweep.
struct StabilityPoint {
  double value = 0.0;
  std::string refused;                ///< why no room could be made; empty: one was made
  bool are_frames_finite = true;      ///< bounds of every frame; its contents are integers
  std::uint64_t recovered_count = 0;  ///< number of times that the watchdog acted
  bool is_well_after = true;          ///< two seconds with the rules' own steps: finite, without the watchdog
  double max_density_ratio = 0.0;     ///< largest rho / rho0; 0 without particles
  double energy_growth = 0.0;         ///< largest energy over the initial energy
  double max_elevation_m = 0.0;       ///< largest |elevation|; 0 without a wave
  double slowest_step_s = 0.0;        ///< wall time of a substep, mean of the slowest tick

  /// No breach, and energy and density within the sweep's bounds.
  bool is_stable = false;
  /// Returns whether no client saw invalid values, nothing hung, and the room still runs.
  [[nodiscard]] bool isSafe() const { return are_frames_finite && is_well_after && slowest_step_s < 10.0; }
};

struct Sweep {
  std::string name;  ///< the swept value
  std::string unit;
  std::vector<double> values;                         ///< in ascending order
  std::optional<double> predicted_bound;              ///< largest stable value by the step rules
  std::function<core::Scene(double)> scene;           ///< with `allow_unstable` if the rules would refuse it
  std::function<void(sim::WaterSim&, double)> start;  ///< called at the start; may be empty
  double seconds = 3.0;                               ///< simulated, per point
  double stable_growth = 0.0;                         ///< largest energy_growth of a stable point
  double stable_density_ratio = 1e9;                  ///< largest max_density_ratio of a stable point
  /// Called before each tick of the sweep; may be empty.
  std::function<void(sim::WaterSim&, double value, int tick)> disturb = {};
  double seconds_after = 2.0;  ///< simulated, with the rules' own steps; must stay healthy
  /// Largest max_elevation_m of a stable point. The energy of an unstable wave is bounded, because no cell gives more
  /// water than it holds; so its height is what shows it.
  double stable_elevation_m = 1e9;
};

/// `quick`: fewer values.
std::vector<Sweep> stabilitySweeps(bool quick);

core::Result<StabilityPoint> runPoint(gpu::Context& ctx, const Sweep& sweep, double value);

/// Returns the largest value up to which every point is stable; nullopt if the first point is not.
std::optional<double> foundBound(const std::vector<StabilityPoint>& points);

}  // namespace spindrift::study
