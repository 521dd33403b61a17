// WaterSim: commands of clients and events of the scene.
#include <shared/bindings.h>
#include <spdlog/spdlog.h>

#include <spindrift/effects/scheduled_effects.h>
#include <spindrift/sim_setup/ground.h>

#include "shader_defines.h"
#include "water_sim_parts.h"

namespace spindrift::sim {
namespace {

core::Error noFloaters() {
  return core::invalid("this scene has no floaters: choose one whose file has \"floaters {}\"");
}

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
  if (!parts_->boats) return core::invalid("this scene has no boats: choose one whose file has \"boats {}\"");
  return parts_->boats->spawn(boat);
}

core::Result<void> WaterSim::controlBoat(std::uint32_t boat_id, double throttle_ratio, double rudder_ratio) {
  if (!parts_->boats) return core::invalid("this scene has no boats");
  return parts_->boats->control(boat_id, throttle_ratio, rudder_ratio);
}

core::Result<void> WaterSim::removeBoat(std::uint32_t boat_id) {
  if (!parts_->boats) return core::invalid("this scene has no boats");
  return parts_->boats->remove(boat_id);
}

core::Result<void> WaterSim::moveBoat(const HullMotion& motion) {
  if (!parts_->boats || !parts_->wave) return core::invalid("this scene has no boats on a wave: no boat can be moved");
  if (auto ready = prepareMovedBoats(); !ready) return ready;
  return parts_->boats->place(motion, *parts_->wave);
}

core::Result<void> WaterSim::releaseBoat(std::uint32_t boat_id) {
  if (!parts_->boats || !parts_->wave) return core::invalid("this scene has no boats on a wave: no boat is moved");
  if (auto ready = prepareMovedBoats(); !ready) return ready;
  return parts_->boats->release(boat_id, *parts_->wave);
}

core::Result<void> WaterSim::prepareMovedBoats() {
  parts_->uniforms.bindUniform(SIM_UNIFORMS);
  Creation create(ctx_, shaderDefines(scene_));
  return parts_->boats->prepareMoved(create);
}

std::vector<HullForces> WaterSim::takeHullForces() {
  return parts_->boats ? parts_->boats->takeForces() : std::vector<HullForces>();
}

std::size_t WaterSim::hullForcesInFlight() const {
  return parts_->boats ? parts_->boats->forcesInFlight() : 0;
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

core::Result<std::uint32_t> WaterSim::spawnFloater(const core::Floater& floater) {
  if (!parts_->floaters) return noFloaters();
  return parts_->floaters->spawn(floater);
}

core::Result<void> WaterSim::holdFloater(const FloaterHold& hold) {
  if (!parts_->floaters) return noFloaters();
  return parts_->floaters->hold(hold);
}

core::Result<void> WaterSim::removeFloater(std::uint32_t floater_id) {
  if (!parts_->floaters) return noFloaters();
  return parts_->floaters->remove(floater_id);
}

core::Result<void> WaterSim::removeFloaters() {
  if (!parts_->floaters) return noFloaters();
  parts_->floaters->removeAll();
  return {};
}

std::uint32_t WaterSim::floaterCount() const {
  return parts_->floaters ? parts_->floaters->count() : 0;
}

std::uint32_t WaterSim::particleCount() const {
  if (!derived_.particles) return 0;
  return parts_->pool ? health_.particle_count : derived_.particles->count;
}

void WaterSim::startEvents() {
  if (scene_.storm) {
    // Effects of clients have priority: a drop without a free slot is dropped.
    for (const core::Effect& effect : stormEffects(scene_, *derived_.wave, tick_ - start_tick_, derived_.tick_s))
      (void)parts_->effects.start(effect, time_s(),
                                  std::holds_alternative<core::Splash>(effect) ? kSpareSplashes : kSpareCrests);
  }
  for (const core::Effect& effect : dueEvents(scene_, time_s(), derived_.tick_s))
    if (auto started = start(effect); !started) spdlog::warn("scene {}: {}", scene_.name, started.error().message);
}

}  // namespace spindrift::sim
