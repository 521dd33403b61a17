#include <algorithm>
#include <chrono>
#include <cmath>

#include <spindrift/study/stability.h>

#include "ticks.h"

namespace spindrift::study {
namespace {

bool isFinite(const core::FrameView& frame) {
  const auto& particles = frame.at(core::Level::kFull).particles;
  if (!particles) return true;
  for (int axis = 0; axis < 3; ++axis) {
    if (!std::isfinite(particles->min_m[axis]) || !std::isfinite(particles->max_m[axis])) return false;
  }
  return true;
}

/// Kinetic energy of particles and wave.
double energyOf(const sim::Health& health) {
  return health.kinetic_energy_j + health.wave_energy_j;
}

/// Scale of the motion: half the weight of the resting particles times their depth, or, without particles, the wave's
/// energy soon after the start.
double energyScale(const sim::WaterSim& water) {
  const auto& particles = water.derived().particles;
  if (particles && !water.scene().coupling)
    return 0.5 * particles->mass_kg * particles->count * water.scene().gravity_mps2 * particles->band_m;
  return 0.0;
}

}  // namespace

core::Result<StabilityPoint> runPoint(gpu::Context& ctx, const Sweep& sweep, double value) {
  StabilityPoint out;
  out.value = value;
  const core::Scene scene = sweep.scene(value);
  auto made = sim::WaterSim::create(ctx, scene);
  if (!made) {
    if (made.error().code != core::ErrorCode::kInvalidInput) return made.error();
    out.refused = made.error().message;
    return out;
  }
  sim::WaterSim& water = **made;
  if (sweep.start) sweep.start(water, value);
  double scale_j = energyScale(water);
  const auto step = [&]() -> core::Result<void> {
    const auto begin = std::chrono::steady_clock::now();
    if (auto done = tick(water); !done) return done;
    ctx.finish();
    const double tick_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    out.slowest_step_s = std::max(out.slowest_step_s, tick_s / std::max(water.derived().substeps_count, 1u));
    (void)water.requestFrame(sim::FrameRequest::allLayers());
    for (const core::FrameView& frame : water.takeFrames())
      out.are_frames_finite = out.are_frames_finite && isFinite(frame);
    return {};
  };
  const double start_s = water.time_s();
  for (int k = 0; water.time_s() < start_s + sweep.seconds; ++k) {
    if (sweep.disturb) sweep.disturb(water, value, k);
    if (auto done = step(); !done) return done.error();
    const sim::Health& health = water.health();
    out.max_density_ratio = std::max(out.max_density_ratio, health.max_density_ratio);
    out.max_elevation_m = std::max(out.max_elevation_m, health.max_elevation_m);
    // The energy of a wave is taken after its start has ended.
    if (scale_j == 0.0 && water.time_s() > start_s + 0.5) scale_j = energyOf(health);
    if (scale_j > 0.0) out.energy_growth = std::max(out.energy_growth, energyOf(health) / scale_j);
  }
  out.recovered_count = water.recoveredCount();
  out.is_stable = out.recovered_count == 0 && out.energy_growth <= sweep.stable_growth &&
                  out.max_density_ratio <= sweep.stable_density_ratio &&
                  out.max_elevation_m <= sweep.stable_elevation_m;

  // Run again with the steps from the rules.
  core::Scene ruled = sweep.disturb ? water.scene() : scene;
  ruled.fixed_substeps_count = 0;
  if (ruled.wave) ruled.wave->fixed_substeps_count = 0;
  if (auto back = water.setScene(ruled); !back) return back.error();
  for (int k = 0; k < 8; ++k) {  // health of the last breach may still be in flight
    if (auto done = step(); !done) return done.error();
  }
  const std::uint64_t recovered_count = water.recoveredCount();
  const double after_s = water.time_s();
  while (water.time_s() < after_s + sweep.seconds_after) {
    if (auto done = step(); !done) return done.error();
  }
  out.is_well_after = water.recoveredCount() == recovered_count && water.health().isGood();
  return out;
}

std::optional<double> foundBound(const std::vector<StabilityPoint>& points) {
  std::optional<double> bound;
  for (const StabilityPoint& point : points) {
    if (!point.is_stable) break;
    bound = point.value;
  }
  return bound;
}

}  // namespace spindrift::study
