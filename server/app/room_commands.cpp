// What a room does with each command. Answers: one Ack or Reject a command; news go to everybody in the room.
#include <variant>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <spindrift/stream/client_message.h>
#include <spindrift/stream/parameters.h>
#include <spindrift/stream/scene_loader.h>
#include <spindrift/stream/server_message.h>

#include "room.h"

namespace spindrift::app {
namespace {

using namespace std::chrono_literals;

/// Ticks of Step that may wait: what one command may ask for.
constexpr std::uint32_t kPendingTickMaxCount = 600;
/// A new scene builds buffers and programs while every room of the thread waits.
constexpr auto kSceneChangeInterval = 1s;

stream::CommandRejection rejection(v1::RejectReason reason, std::string field, std::string message) {
  return {.command_id = 0, .reason = reason, .field = std::move(field), .message = std::move(message)};
}

/// Errors of several lines (one a field) in one.
std::string firstLine(const std::string& text) {
  const std::size_t end = text.find('\n');
  return end == std::string::npos ? text : text.substr(0, end) + " (and more)";
}

/// Why a running room does not take a scene.
v1::RejectReason whyNot(core::Scene wanted) {
  // What could be started afresh only needs other buffers or programs than the room has.
  if (sim::derive(wanted)) return v1::REJECT_REASON_NEEDS_RESTART;
  wanted.allow_unstable = true;
  wanted.fixed_substeps_count = 1;
  return sim::derive(wanted) ? v1::REJECT_REASON_BREAKS_STEP_RULE : v1::REJECT_REASON_OUT_OF_RANGE;
}

template <class... F>
struct Overloaded : F... {
  using F::operator()...;
};
template <class... F>
Overloaded(F...) -> Overloaded<F...>;

}  // namespace

void Room::applyCommands(net::Hub& hub, RoomObserver& observer) {
  for (const core::Command& command : commands_.drain()) {
    spawned_boat_id_ = 0;
    if (auto rejected = apply(command, hub, observer)) {
      rejected->command_id = command.command_id;
      hub.sendControl(command.session_id, stream::reject(*rejected));
    } else {
      hub.sendControl(command.session_id, stream::ack(command.command_id, tick(), spawned_boat_id_));
    }
  }
}

Room::Outcome Room::apply(const core::Command& command, net::Hub& hub, RoomObserver& observer) {
  // Checked against the scene when it arrived; the scene may be another one since.
  if (auto rejected = stream::checkAgainstScene(command, scene_)) return rejected;
  return std::visit(Overloaded{[&](const core::Splash& splash) { return applyEffect(splash); },
                               [&](const core::BreakingWave& wave) { return applyEffect(wave); },
                               [&](const core::SetParameter& change) { return setParameter(change, hub); },
                               [&](const core::Reset&) { return reset(hub); },
                               [&](const core::SetPaused& pause) -> Outcome {
                                 if (paused_ && !pause.paused) clock_.restart(std::chrono::steady_clock::now());
                                 paused_ = pause.paused;
                                 pending_tick_count_ = 0;
                                 announceState(hub);
                                 return {};
                               },
                               [&](const core::SetSpeed& speed) -> Outcome {
                                 clock_.setSpeed(speed.speed);
                                 announceState(hub);
                                 return {};
                               },
                               [&](const core::SpawnBoat& spawn) { return spawnBoat(spawn, hub); },
                               [&](const core::ControlBoat& control) { return controlBoat(control); },
                               [&](const core::RemoveBoat& remove) { return removeBoat(remove, hub); },
                               [&](const core::Step& step) { return advance(step); },
                               [&](const core::ChangeScene& change) { return changeScene(change, observer); }},
                    command.action);
}

Room::Outcome Room::applyEffect(const core::Effect& effect) {
  const auto started = sim_->start(effect);
  if (started) return {};
  const bool busy = started.error().code == core::ErrorCode::kUnavailable;
  return rejection(busy ? v1::REJECT_REASON_BUSY : v1::REJECT_REASON_ABSENT_PART, "", started.error().message);
}

Room::Outcome Room::setParameter(const core::SetParameter& change, net::Hub& hub) {
  v1::Scene changed = scene_;
  if (auto error = stream::setParameter(changed, change.path, change.value)) {
    return rejection(error->reason, error->field, error->message);
  }
  const core::Scene wanted = stream::toCore(changed);
  if (auto applied = sim_->setScene(wanted); !applied)
    return rejection(whyNot(wanted), change.path, applied.error().message);
  scene_ = std::move(changed);
  publishSnapshot();
  hub.broadcastControl(name_, stream::parameterChanged(change.path, change.value, tick()));
  return {};
}

Room::Outcome Room::reset(net::Hub& hub) {
  sim_->reset();
  next_frame_s_ = 0.0;
  next_idle_frame_ = {};
  pending_tick_count_ = 0;
  hub.broadcastControl(name_, stream::roomEvent(v1::ROOM_EVENT_KIND_RESET, tick(), "somebody started the scene again"));
  announceBoats(hub);
  return {};
}

Room::Outcome Room::spawnBoat(const core::SpawnBoat& spawn, net::Hub& hub) {
  const auto boat_id = sim_->spawnBoat(spawn.boat);
  if (!boat_id) {
    const bool full = boat_id.error().code == core::ErrorCode::kUnavailable;
    return rejection(full ? v1::REJECT_REASON_BUSY : v1::REJECT_REASON_ABSENT_PART, "spawn_boat",
                     boat_id.error().message);
  }
  spawned_boat_id_ = *boat_id;
  announceBoats(hub);
  return {};
}

Room::Outcome Room::controlBoat(const core::ControlBoat& control) {
  const auto done = sim_->controlBoat(control.boat_id, control.throttle_ratio, control.rudder_ratio);
  if (done) return {};
  return rejection(v1::REJECT_REASON_UNKNOWN_BOAT, "control_boat.boat_id", done.error().message);
}

Room::Outcome Room::removeBoat(const core::RemoveBoat& remove, net::Hub& hub) {
  if (const auto done = sim_->removeBoat(remove.boat_id); !done) {
    return rejection(v1::REJECT_REASON_UNKNOWN_BOAT, "remove_boat.boat_id", done.error().message);
  }
  announceBoats(hub);
  return {};
}

Room::Outcome Room::advance(const core::Step& step) {
  if (!paused_) {
    return rejection(v1::REJECT_REASON_OUT_OF_RANGE, "step", "the room is running; pause it first, then step");
  }
  if (pending_tick_count_ + step.tick_count > kPendingTickMaxCount) {
    return rejection(v1::REJECT_REASON_BUSY, "step.tick_count",
                     fmt::format("{} ticks more than the {} still to come are above {}; try again when they are done",
                                 step.tick_count, pending_tick_count_, kPendingTickMaxCount));
  }
  pending_tick_count_ += step.tick_count;
  return {};
}

Room::Outcome Room::changeScene(const core::ChangeScene& change, RoomObserver& observer) {
  const char* const kField = "change_scene.name";
  const auto now = std::chrono::steady_clock::now();
  if (!scenes_.has(change.name)) {
    return rejection(v1::REJECT_REASON_UNKNOWN_SCENE, kField,
                     "there is no scene '" + change.name + "'; the greeting lists what there is");
  }
  if (now < next_scene_change_) {
    return rejection(v1::REJECT_REASON_BUSY, kField, "the scene was changed a moment ago; try again in a second");
  }
  auto scene = scenes_.load(change.name);
  if (!scene) return rejection(v1::REJECT_REASON_UNKNOWN_SCENE, kField, firstLine(scene.error().message));
  auto sim = createWarm(ctx_, *scene);
  if (!sim) {
    return rejection(v1::REJECT_REASON_OUT_OF_RANGE, kField,
                     "scene '" + change.name + "': " + firstLine(sim.error().message));
  }
  // The new scene begins at a tick that no frame of the old one has.
  const std::uint64_t first_tick = tick() + 1;
  sim_ = *std::move(sim);
  scene_ = *std::move(scene);
  tick_shift_ = first_tick - sim_->tick();
  const double speed = clock_.speed();
  clock_ = RealTimeClock(sim_->derived().tick_s);
  clock_.setSpeed(speed);
  const auto ready = std::chrono::steady_clock::now();
  clock_.restart(ready);
  last_run_ = ready;
  next_scene_change_ = ready + kSceneChangeInterval;
  next_frame_s_ = 0.0;
  next_idle_frame_ = {};
  pending_tick_count_ = 0;
  frames_in_flight_ = 0;
  wants_diagnostics_ = false;
  step_ms_sum_ = last_step_ms_ = 0.0;
  step_count_ = 0;
  last_passes_.clear();
  slow_since_ = {};
  recovery_news_.restart(sim_->recoveredCount());
  readBoats();
  publishSnapshot();
  spdlog::info("room {}: scene {}", name_, scene_.name());
  observer.sceneChanged(*this);
  return {};
}

void Room::announceState(net::Hub& hub) {
  publishSnapshot();
  hub.broadcastControl(name_, stream::roomState(paused_, clock_.speed()));
}

void Room::announceBoats(net::Hub& hub) {
  const std::string before = boats_.SerializeAsString();
  readBoats();
  if (boats_.SerializeAsString() == before) return;
  publishSnapshot();
  hub.broadcastControl(name_, stream::boatList(boats_));
}

void Room::announceRecovery(TimePoint now, net::Hub& hub) {
  const std::uint64_t count = sim_->recoveredCount();
  if (!recovery_news_.tell(count, now)) return;
  hub.broadcastControl(
      name_,
      stream::roomEvent(v1::ROOM_EVENT_KIND_RECOVERED, tick(),
                        fmt::format("the guard put the water back to its last good state ({} times so far)", count)));
  announceBoats(hub);
}

}  // namespace spindrift::app
