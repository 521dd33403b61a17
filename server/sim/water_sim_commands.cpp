// WaterSim: what people and scenes ask of it.
#include <algorithm>
#include <cmath>

#include <spdlog/spdlog.h>

#include "relay_particles.h"
#include "storm.h"
#include "water_sim_parts.h"

namespace spindrift::sim {
namespace {

using core::Error;
using core::ErrorCode;

/// A splash reaches at most this share of the way to the ground.
constexpr double kLargestDepthShare = 0.9;

}  // namespace

core::Result<void> WaterSim::start(const core::Effect& effect) {
  auto started = parts_->effects.start(effect, time_s());
  const auto* splash = std::get_if<core::Splash>(&effect);
  if (started && splash && parts_->follower) parts_->follower->goTo(splash->x_m, splash->z_m);
  return started;
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

std::uint32_t WaterSim::particleCount() const {
  if (!derived_.particles) return 0;
  return parts_->pool ? health_.particle_count : derived_.particles->count;
}

core::Result<void> WaterSim::setScene(const core::Scene& scene) {
  auto fresh = derive(scene);
  if (!fresh) return fresh.error();
  const bool relays = scene.particles && scene_.particles && scene.particles->count != scene_.particles->count;
  // Compared with a fresh start of the scene as it was, but for the number of particles: the running layout may be one
  // that no fresh start has.
  // A pool's places are counted on the device and do not move.
  if (relays && parts_->pool) {
    return Error{
        ErrorCode::kInvalidInput,
        "particles.count: is the size of the pool of this two-way scene: start the room again with the changed scene"};
  }
  core::Scene comparable = scene_;
  if (relays) comparable.particles->count = scene.particles->count;
  const auto before = derive(comparable);
  if (!before || needsRestart(*before, *fresh) || shaderDefines(scene_) != shaderDefines(scene) ||
      (scene.particles && scene.particles->solver != scene_.particles->solver)) {
    return Error{ErrorCode::kInvalidInput,
                 "this change needs new buffers or shaders: start the room again with the changed scene"};
  }
  if (relays) {
    if (auto relaid = relay(scene); !relaid) return relaid.error();
  }
  // Water that is taken away takes its motion with it; water that is added is at rest.
  const bool is_shallower = scene.wave && scene.wave->depth_m < scene_.wave->depth_m;
  if (is_shallower) parts_->wave->scaleFlow(scene.wave->depth_m / scene_.wave->depth_m);
  scene_ = scene;
  setCareful(is_careful_);
  if (is_shallower) parts_->wave->fillUpToBed(scene_, *derived_.wave);
  return {};
}

core::Result<void> WaterSim::relay(const core::Scene& scene) {
  const auto layout = layOutAgain(scene, *derived_.particles);
  if (!layout) return layout.error();
  auto derived = derive(scene, &*layout);
  if (!derived) return derived.error();
  const StateCopy state = copyState();
  const RelaidParticles particles = relayParticles(scene, derived_, state, *layout);
  if (auto sized = parts_->resize(ctx_, scene, *derived); !sized) {
    // The device refused. Back to the old size, which it held a moment ago, and to the old state.
    if (auto back = parts_->resize(ctx_, scene_, derived_); !back) return back.error();
    setState(state);
    return sized.error();
  }
  derived_ = *std::move(derived);
  parts_->particles->position.upload(particles.position);
  parts_->particles->velocity.upload(particles.velocity);
  parts_->particles->acceleration.upload(std::vector<float>(std::size_t{derived_.particles->count} * 4,
                                                            static_cast<float>(scene.particles->rest_density_kgpm3)));
  ctx_.barrier(gpu::Barrier::kBufferUpdate | gpu::Barrier::kStorageAndTexel);
  abandoned_until_tick_ = tick_;  // what is still to come is about the old particles
  return {};
}

void WaterSim::startEvents() {
  if (scene_.storm) {
    for (const core::Effect& effect : stormEffects(scene_, *derived_.wave, tick_ - start_tick_, derived_.tick_s)) {
      // Weather gives way to people: a drop that finds no place does not fall.
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
    // The scene was checked with the depth it began with; an effect shrinks with water that was made shallower since.
    if (auto* splash = std::get_if<core::Splash>(&effect); splash && scene_.wave) {
      splash->depth_m = std::min(splash->depth_m, kLargestDepthShare * scene_.wave->depth_m);
    }
    if (auto started = start(effect); !started) spdlog::warn("scene {}: {}", scene_.name, started.error().message);
  }
}

}  // namespace spindrift::sim
