#include <algorithm>
#include <cmath>

#include <shared/event_uniforms.h>

#include <spindrift/core/random.h>
#include <spindrift/effects/scheduled_effects.h>
#include <spindrift/effects/strokes.h>
#include <spindrift/sim_setup/scene_parts.h>

namespace spindrift::sim {
namespace {

constexpr double kDropDuration_s = 0.08;
constexpr double kDropDepthShare = 0.1;  ///< of the water's depth, at most
/// Gusts at full storm: mean interval of the groups, their length, and the spread of their direction about the
/// wind.
constexpr double kGroupInterval_s = 1.6;
constexpr double kGroupLengthShare = 0.09;  ///< of the shorter side of the water
constexpr double kGroupSpread_deg = 25.0;
constexpr double kWaveDepthShare = 0.5;  ///< of the water's depth, at most

/// Largest depth of a splash, as a share of the water's depth.
constexpr double kLargestDepthShare = 0.9;

}  // namespace

std::vector<core::Effect> dueEvents(const core::Scene& scene, double from_s, double tick_s) {
  std::vector<core::Effect> out;
  const double to_s = from_s + tick_s;
  for (const core::TimedEvent& event : scene.events) {
    const double repeats =
        event.every_s > 0 ? std::max(0.0, std::ceil((from_s - event.at_s) / event.every_s - 1e-9)) : 0.0;
    const double due_s = event.at_s + repeats * event.every_s;
    if (due_s < from_s - 1e-9 || due_s >= to_s - 1e-9) continue;
    core::Effect& effect = out.emplace_back(event.effect);
    if (auto* splash = std::get_if<core::Splash>(&effect); splash && scene.wave)
      splash->depth_m = std::min(splash->depth_m, kLargestDepthShare * scene.wave->depth_m);
  }
  return out;
}

std::vector<core::Effect> stormEffects(const core::Scene& scene, const WaveLayout& wave, std::uint64_t tick,
                                       double tick_s) {
  std::vector<core::Effect> out;
  if (!scene.storm || scene.storm->level_ratio <= 0) return out;
  const core::StormScene& storm = *scene.storm;
  core::SplitMix64 random(scene.seed * 0x2545f4914f6cdd1dull + tick);

  const double drops = storm.level_ratio * storm.drops_per_m2_s * wave.length_m * wave.width_m * tick_s;
  auto count = static_cast<std::size_t>(drops);
  if (random.unit() < drops - static_cast<double>(count)) ++count;
  count = std::min(count, static_cast<std::size_t>(MAX_SPLASHES) - kSpareSplashes);
  const double depth_m = std::min(storm.drop_depth_m, kDropDepthShare * scene.wave->depth_m);
  for (std::size_t k = 0; k < count; ++k) {
    core::Splash drop;
    drop.x_m = 0.5 * wave.length_m * random.symmetric();
    drop.z_m = 0.5 * wave.width_m * random.symmetric();
    drop.radius_m = kDropRadius_cells * wave.cell_m;
    drop.depth_m = depth_m * (0.5 + 0.5 * random.unit());
    drop.duration_s = kDropDuration_s;
    out.emplace_back(drop);
  }

  if (!hasWindSea(scene) && random.unit() < storm.level_ratio * tick_s / kGroupInterval_s) {
    core::BreakingWave gust;
    gust.side = core::Side::kDirection;
    gust.shape = core::WaveShape::kSwell;
    gust.direction_deg = storm.wind_direction_deg + kGroupSpread_deg * random.symmetric();
    gust.amplitude_m = storm.level_ratio * std::min(storm.wave_height_m, kWaveDepthShare * scene.wave->depth_m) *
                       (0.4 + 0.6 * random.unit());
    gust.length_m = kGroupLengthShare * wave.shorterSide_m() * (0.7 + 0.6 * random.unit());
    gust.duration_s = 0.4;
    out.emplace_back(gust);
  }
  return out;
}

}  // namespace spindrift::sim
