#include "stage.h"

#include <cassert>
#include <utility>
#include <variant>

#include <spindrift/stream/parameters.h>
#include <spindrift/stream/scene_loader.h>

#include "overloaded.h"

namespace spindrift::app {
namespace {

/// Why a running room does not take a scene.
v1::RejectReason whyNot(core::Scene wanted) {
  // What could be started afresh only needs other buffers or programs than the room has.
  if (sim::derive(wanted)) return v1::REJECT_REASON_NEEDS_RESTART;
  wanted.allow_unstable = true;
  wanted.fixed_substeps_count = 1;
  return sim::derive(wanted) ? v1::REJECT_REASON_BREAKS_STEP_RULE : v1::REJECT_REASON_OUT_OF_RANGE;
}

}  // namespace

stream::CommandRejection rejection(v1::RejectReason reason, std::string field, std::string message) {
  return {.command_id = 0, .reason = reason, .field = std::move(field), .message = std::move(message)};
}

std::string firstLine(const std::string& text) {
  const std::size_t end = text.find('\n');
  return end == std::string::npos ? text : text.substr(0, end) + " (and more)";
}

core::Result<std::unique_ptr<sim::WaterSim>> createWarm(gpu::Context& ctx, const v1::Scene& scene,
                                                        std::uint32_t first_boat_id) {
  // A step's shaders are compiled when they first run, which takes a software device seconds; diagnostics run every
  // fourth tick, so as many ticks leave their rhythm as it was.
  constexpr int kWarmUpTickCount = 4;
  auto sim = sim::WaterSim::create(ctx, stream::toCore(scene));
  if (!sim) return sim;
  for (int i = 0; i < kWarmUpTickCount; ++i) (*sim)->step();
  (void)(*sim)->requestFrame({.surface = true, .particles = true, .foam = true, .bodies = true});
  ctx.finish();
  (void)(*sim)->takeFrames();
  (void)(*sim)->takePassCosts();
  (*sim)->numberBoatsFrom(first_boat_id);
  (*sim)->reset();
  return sim;
}

Stage::Stage(gpu::Context& ctx, v1::Scene scene, std::unique_ptr<sim::WaterSim> sim)
    : ctx_(ctx), scene_(std::move(scene)), sim_(std::move(sim)), tick_shift_(0 - sim_->tick()) {}

core::Result<std::unique_ptr<Stage>> Stage::create(gpu::Context& ctx, v1::Scene scene) {
  auto sim = createWarm(ctx, scene);
  if (!sim) return sim.error();
  return std::unique_ptr<Stage>(new Stage(ctx, std::move(scene), *std::move(sim)));
}

bool Stage::takes(const core::Action& action) {
  return std::visit(
      Overloaded{[](const core::SetPaused&) { return false; }, [](const core::SetSpeed&) { return false; },
                 [](const core::Step&) { return false; }, [](const core::ChangeScene&) { return false; },
                 [](const core::TakeBoat&) { return false; }, [](const auto&) { return true; }},
      action);
}

Stage::Outcome Stage::apply(const core::Action& action) {
  assert(takes(action));
  Outcome outcome = std::visit(Overloaded{[&](const core::Splash& splash) { return startEffect(splash); },
                                          [&](const core::BreakingWave& wave) { return startEffect(wave); },
                                          [&](const core::SetParameter& change) { return setParameter(change); },
                                          [&](const core::Reset&) -> Outcome {
                                            sim_->reset();
                                            return {};
                                          },
                                          [&](const core::SpawnBoat& spawn) { return spawnBoat(spawn); },
                                          [&](const core::ControlBoat& control) { return controlBoat(control); },
                                          [&](const core::RemoveBoat& remove) { return removeBoat(remove); },
                                          [&](const auto&) -> Outcome { return {}; }},
                               action);
  if (!outcome) ++state_id_;
  return outcome;
}

Stage::Outcome Stage::startEffect(const core::Effect& effect) {
  const auto started = sim_->start(effect);
  if (started) return {};
  const bool busy = started.error().code == core::ErrorCode::kUnavailable;
  return rejection(busy ? v1::REJECT_REASON_BUSY : v1::REJECT_REASON_ABSENT_PART, "", started.error().message);
}

Stage::Outcome Stage::setParameter(const core::SetParameter& change) {
  v1::Scene changed = scene_;
  if (auto error = stream::setParameter(changed, change.path, change.value)) {
    return rejection(error->reason, error->field, error->message);
  }
  const core::Scene wanted = stream::toCore(changed);
  if (auto applied = sim_->setScene(wanted); !applied) {
    // The message begins with the field that breaks a rule, which Reject.field says already where it is this one.
    const std::string& message = applied.error().message;
    const std::string own = change.path + ": ";
    return rejection(whyNot(wanted), change.path, message.starts_with(own) ? message.substr(own.size()) : message);
  }
  scene_ = std::move(changed);
  return {};
}

Stage::Outcome Stage::spawnBoat(const core::SpawnBoat& spawn) {
  const auto boat_id = sim_->spawnBoat(spawn.boat);
  if (!boat_id) {
    const bool full = boat_id.error().code == core::ErrorCode::kUnavailable;
    return rejection(full ? v1::REJECT_REASON_BUSY : v1::REJECT_REASON_ABSENT_PART, "spawn_boat",
                     boat_id.error().message);
  }
  spawned_boat_id_ = *boat_id;
  return {};
}

Stage::Outcome Stage::controlBoat(const core::ControlBoat& control) {
  const auto done = sim_->controlBoat(control.boat_id, control.throttle_ratio, control.rudder_ratio);
  if (done) return {};
  return rejection(v1::REJECT_REASON_UNKNOWN_BOAT, "control_boat.boat_id", done.error().message);
}

Stage::Outcome Stage::removeBoat(const core::RemoveBoat& remove) {
  const auto done = sim_->removeBoat(remove.boat_id);
  if (done) return {};
  return rejection(v1::REJECT_REASON_UNKNOWN_BOAT, "remove_boat.boat_id", done.error().message);
}

Stage::Outcome Stage::replaceScene(v1::Scene scene) {
  auto sim = createWarm(ctx_, scene, sim_->nextBoatId());
  if (!sim) {
    return rejection(v1::REJECT_REASON_OUT_OF_RANGE, "change_scene.name",
                     "scene '" + scene.name() + "': " + firstLine(sim.error().message));
  }
  const std::uint64_t first_tick = tick() + 1;
  sim_ = *std::move(sim);
  scene_ = std::move(scene);
  tick_shift_ = first_tick - sim_->tick();
  ++state_id_;
  return {};
}

v1::BoatList Stage::boats() const {
  v1::BoatList out;
  for (const sim::BoatRecord& boat : sim_->boats()) {
    v1::BoatInfo& info = *out.add_boats();
    info.set_boat_id(boat.boat_id);
    info.set_length_m(boat.length_m);
    info.set_beam_m(boat.beam_m);
    info.set_height_m(boat.height_m);
    info.set_draught_m(boat.draught_m);
  }
  return out;
}

}  // namespace spindrift::app
