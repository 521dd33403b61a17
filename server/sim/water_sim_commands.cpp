// WaterSim: commands of clients and events of the scene.
#include <algorithm>
#include <cmath>

#include <spdlog/spdlog.h>

#include <spindrift/sim_setup/open_side.h>
#include <spindrift/sim_setup/storm.h>

#include "water_sim_parts.h"

namespace spindrift::sim {
namespace {

using core::Error;
using core::ErrorCode;

/// Largest depth of a splash, as a share of the water's depth.
constexpr double kLargestDepthShare = 0.9;

}  // namespace

core::Result<void> WaterSim::start(const core::Effect& effect) {
  core::Effect complete = effect;
  if (auto* wave = std::get_if<core::BreakingWave>(&complete); wave && !wave->side) wave->side = openSide(scene_);
  auto started = parts_->effects.start(complete, time_s());
  const auto* splash = std::get_if<core::Splash>(&effect);
  if (started && splash && parts_->follower) parts_->follower->goTo(splash->x_m, splash->z_m);
  return started;
}

core::Result<void> WaterSim::draw(const StrokePart& part) {
  const std::size_t before_count = strokes().size();
  auto drawn = parts_->effects.strokes().add(part);
  if (parts_->follower && strokes().size() > before_count)
    parts_->follower->goTo(part.points.front().x_m, part.points.front().z_m);
  return drawn;
}

const std::vector<Stroke>& WaterSim::strokes() const {
  return parts_->effects.strokes().active();
}

core::Result<std::uint32_t> WaterSim::spawnBoat(const core::Boat& boat) {
  if (!parts_->boats)
    return Error{ErrorCode::kInvalidInput, "this scene has no boats: choose one whose file has \"boats {}\""};
  return parts_->boats->spawn(boat);
}

core::Result<void> WaterSim::controlBoat(std::uint32_t boat_id, double throttle_ratio, double rudder_ratio) {
  if (!parts_->boats) return Error{ErrorCode::kInvalidInput, "this scene has no boats"};
  return parts_->boats->control(boat_id, throttle_ratio, rudder_ratio);
}

core::Result<void> WaterSim::removeBoat(std::uint32_t boat_id) {
  if (!parts_->boats) return Error{ErrorCode::kInvalidInput, "this scene has no boats"};
  return parts_->boats->remove(boat_id);
}

std::vector<BoatRecord> WaterSim::boats() const {
  return parts_->boats ? parts_->boats->records() : std::vector<BoatRecord>{};
}

void WaterSim::numberBoatsFrom(std::uint32_t first_id) {
  first_boat_id_ = first_id;
  if (!parts_->boats) return;
  parts_->boats->numberFrom(first_id);
  parts_->boats->reset(scene_);
}

std::uint32_t WaterSim::nextBoatId() const {
  return parts_->boats ? parts_->boats->nextId() : first_boat_id_;
}

std::uint32_t WaterSim::particleCount() const {
  if (!derived_.particles) return 0;
  return parts_->pool ? health_.particle_count : derived_.particles->count;
}

void WaterSim::startEvents() {
  if (scene_.storm) {
    for (const core::Effect& effect : stormEffects(scene_, *derived_.wave, tick_ - start_tick_, derived_.tick_s)) {
      // Effects of clients have priority: a drop without a free slot is dropped.
      (void)parts_->effects.start(effect, time_s(),
                                  std::holds_alternative<core::Splash>(effect) ? kSpareSplashes : kSpareCrests);
    }
  }
  const double from_s = time_s();
  const double to_s = from_s + derived_.tick_s;
  for (const core::TimedEvent& event : scene_.events) {
    const double repeats =
        event.every_s > 0 ? std::max(0.0, std::ceil((from_s - event.at_s) / event.every_s - 1e-9)) : 0.0;
    const double due_s = event.at_s + repeats * event.every_s;
    if (due_s < from_s - 1e-9 || due_s >= to_s - 1e-9) continue;
    core::Effect effect = event.effect;
    // The scene's events were checked for its first depth; reduce them if the water has become shallower.
    if (auto* splash = std::get_if<core::Splash>(&effect); splash && scene_.wave) {
      splash->depth_m = std::min(splash->depth_m, kLargestDepthShare * scene_.wave->depth_m);
    }
    if (auto started = start(effect); !started) spdlog::warn("scene {}: {}", scene_.name, started.error().message);
  }
}

}  // namespace spindrift::sim
