// What a room does with each command. Every command gets one answer; news go to everybody in the room.
#include <set>
#include <variant>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <spindrift/stream/client_message.h>
#include <spindrift/stream/server_message.h>

#include "access.h"
#include "overloaded.h"
#include "room.h"

namespace spindrift::app {
namespace {

using namespace std::chrono_literals;

/// Ticks of Step that may wait: what one command may ask for.
constexpr std::uint32_t kPendingTickMaxCount = 600;
/// A new scene builds buffers and programs while every room of the thread waits.
constexpr auto kSceneChangeInterval = 1s;
/// A crowd that joins is announced in a few lists, not in one a head.
constexpr auto kPeopleNewsInterval = 200ms;

/// A boat that somebody else has, or nobody.
stream::CommandRejection notYours(std::string field, std::uint32_t boat_id, std::uint32_t owner_id) {
  return rejection(v1::REJECT_REASON_NOT_YOURS, std::move(field),
                   owner_id == 0 ? fmt::format("boat {} is nobody's: take it first", boat_id)
                                 : fmt::format("boat {} is person {}'s", boat_id, owner_id));
}

}  // namespace

std::optional<stream::CommandRejection> Room::admit(core::Command command) {
  const core::Sender& sender = command.sender;
  Outcome refused;
  if (const core::Role needed = core::roleFor(command.action); sender.role < needed) {
    refused = rejection(v1::REJECT_REASON_FORBIDDEN, "",
                        fmt::format("this takes the role of {}; yours is {}", roleName(needed), roleName(sender.role)));
  } else {
    refused = stream::checkAgainstScene(command, snapshot()->scene);
  }
  const std::uint64_t command_id = command.command_id;
  if (!refused && !commands_.tryPush(std::move(command))) {
    refused = rejection(v1::REJECT_REASON_BUSY, "", "the room's command queue is full: try again");
  }
  if (refused) refused->command_id = command_id;
  return refused;
}

void Room::applyCommands(net::Hub& hub, RoomObserver& observer) {
  for (const core::Command& command : commands_.drain()) {
    if (auto rejected = apply(command, hub, observer)) {
      rejected->command_id = command.command_id;
      observer.commandRejected(command, *rejected);
    } else {
      const bool is_spawn = std::holds_alternative<core::SpawnBoat>(command.action);
      observer.commandApplied(command, tick(), is_spawn ? stage_->spawnedBoatId() : 0);
    }
  }
}

void Room::abandonCommands(RoomObserver& observer) {
  for (const core::Command& command : commands_.drain()) {
    stream::CommandRejection closed = rejection(v1::REJECT_REASON_BUSY, "", "the room was closed");
    closed.command_id = command.command_id;
    observer.commandRejected(command, closed);
  }
}

Room::Outcome Room::apply(const core::Command& command, net::Hub& hub, RoomObserver& observer) {
  // Checked against the scene when it arrived; the scene may be another one since.
  if (auto rejected = stream::checkAgainstScene(command, stage_->scene())) return rejected;
  return std::visit(Overloaded{[&](const core::Splash&) { return applyToWater(command); },
                               [&](const core::BreakingWave&) { return applyToWater(command); },
                               [&](const core::SetParameter& change) { return setParameter(command, change, hub); },
                               [&](const core::Reset&) { return reset(command, hub); },
                               [&](const core::SetPaused& pause) { return setPaused(pause.paused, hub); },
                               [&](const core::SetSpeed& speed) -> Outcome {
                                 clock_.setSpeed(speed.speed);
                                 announceState(hub);
                                 return {};
                               },
                               [&](const core::SpawnBoat&) { return spawnBoat(command, hub); },
                               [&](const core::ControlBoat& control) { return controlBoat(command, control.boat_id); },
                               [&](const core::RemoveBoat& remove) { return removeBoat(command, remove.boat_id, hub); },
                               [&](const core::TakeBoat& take) { return takeBoat(command.sender, take.boat_id); },
                               [&](const core::Step& step) { return advance(step); },
                               [&](const core::ChangeScene& change) { return changeScene(change, observer); }},
                    command.action);
}

Room::Outcome Room::applyToWater(const core::Command& command) {
  if (auto rejected = stage_->apply(command.action)) return rejected;
  if (log_) {
    v1::Record line;
    *line.mutable_command() = stream::toWire(command);
    record(std::move(line));
  }
  return {};
}

Room::Outcome Room::setParameter(const core::Command& command, const core::SetParameter& change, net::Hub& hub) {
  if (auto rejected = applyToWater(command)) return rejected;
  publishSnapshot();
  hub.broadcastControl(name_, stream::parameterChanged(change.path, change.value, tick()));
  return {};
}

Room::Outcome Room::reset(const core::Command& command, net::Hub& hub) {
  if (auto rejected = applyToWater(command)) return rejected;
  next_frame_s_ = 0.0;
  next_idle_frame_ = {};
  pending_tick_count_ = 0;
  hub.broadcastControl(name_, stream::roomEvent(v1::ROOM_EVENT_KIND_RESET, tick(), "somebody started the scene again"));
  announceBoats(hub);
  return {};
}

Room::Outcome Room::setPaused(bool paused, net::Hub& hub) {
  if (paused_ && !paused) clock_.restart(std::chrono::steady_clock::now());
  paused_ = paused;
  pending_tick_count_ = 0;
  announceState(hub);
  return {};
}

// Boats

Room::Outcome Room::spawnBoat(const core::Command& command, net::Hub& hub) {
  const core::Sender& sender = command.sender;
  if (sender.role < core::Role::kOperator && roster_.hasBoat(sender.person_id)) {
    return rejection(v1::REJECT_REASON_HAS_BOAT, "spawn_boat", "you have a boat: remove it before you launch another");
  }
  if (auto rejected = applyToWater(command)) return rejected;
  roster_.give(stage_->spawnedBoatId(), sender.person_id);
  announceBoats(hub);
  return {};
}

Room::Outcome Room::controlBoat(const core::Command& command, std::uint32_t boat_id) {
  const std::uint32_t owner_id = roster_.ownerOf(boat_id);
  const bool is_free_to_operators = owner_id == 0 && command.sender.role >= core::Role::kOperator;
  const bool is_own = owner_id != 0 && owner_id == command.sender.person_id;
  if (!is_own && !is_free_to_operators && isOnTheWater(boat_id)) {
    return notYours("control_boat.boat_id", boat_id, owner_id);
  }
  return applyToWater(command);
}

Room::Outcome Room::removeBoat(const core::Command& command, std::uint32_t boat_id, net::Hub& hub) {
  const std::uint32_t owner_id = roster_.ownerOf(boat_id);
  const bool is_own = owner_id != 0 && owner_id == command.sender.person_id;
  if (!is_own && command.sender.role < core::Role::kOperator && isOnTheWater(boat_id)) {
    return notYours("remove_boat.boat_id", boat_id, owner_id);
  }
  if (auto rejected = applyToWater(command)) return rejected;
  announceBoats(hub);
  return {};
}

Room::Outcome Room::takeBoat(const core::Sender& sender, std::uint32_t boat_id) {
  const char* const kField = "take_boat.boat_id";
  if (!isOnTheWater(boat_id)) {
    return rejection(v1::REJECT_REASON_UNKNOWN_BOAT, kField, fmt::format("there is no boat {} on the water", boat_id));
  }
  if (sender.person_id == 0) {
    return rejection(v1::REJECT_REASON_FORBIDDEN, kField, "only somebody in the room can take a boat: connect first");
  }
  const std::uint32_t owner_id = roster_.ownerOf(boat_id);
  if (owner_id == sender.person_id) return {};
  const bool is_operator = sender.role >= core::Role::kOperator;
  if (owner_id != 0 && !is_operator) return notYours(kField, boat_id, owner_id);
  if (!is_operator && roster_.hasBoat(sender.person_id)) {
    return rejection(v1::REJECT_REASON_HAS_BOAT, kField, "you have a boat: remove it before you take another");
  }
  roster_.give(boat_id, sender.person_id);
  return {};
}

bool Room::isOnTheWater(std::uint32_t boat_id) const {
  for (const v1::BoatInfo& boat : boats_.boats()) {
    if (boat.boat_id() == boat_id) return true;
  }
  return false;
}

void Room::settlePeople(TimePoint now, net::Hub& hub) {
  const Roster::Turn turn = roster_.settle(now);
  for (const std::uint32_t boat_id : turn.boats_to_stop) {
    (void)applyToWater({.action = core::ControlBoat{.boat_id = boat_id}});  // it may be gone already
  }
  has_people_news_ = has_people_news_ || turn.is_news;
  if (!has_people_news_ || now < next_people_news_) return;
  has_people_news_ = false;
  next_people_news_ = now + kPeopleNewsInterval;
  hub.broadcastControl(name_, stream::people(roster_.people()));
}

// Time and scenes

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
  if (!rules_.scenes.has(change.name)) {
    return rejection(v1::REJECT_REASON_UNKNOWN_SCENE, kField,
                     "there is no scene '" + change.name + "'; the greeting lists what there is");
  }
  if (now < next_scene_change_) {
    return rejection(v1::REJECT_REASON_BUSY, kField, "the scene was changed a moment ago; try again in a second");
  }
  auto scene = rules_.scenes.load(change.name);
  if (!scene) return rejection(v1::REJECT_REASON_UNKNOWN_SCENE, kField, firstLine(scene.error().message));
  if (auto rejected = stage_->replaceScene(*std::move(scene))) return rejected;
  if (log_) {
    v1::Record line;
    *line.mutable_scene() = stage_->scene();
    record(std::move(line));
  }
  const double speed = clock_.speed();
  clock_ = RealTimeClock(stage_->water().derived().tick_s);
  clock_.setSpeed(speed);
  const auto ready = std::chrono::steady_clock::now();
  clock_.restart(ready);
  last_run_ = last_watched_ = ready;
  asleep_ = false;
  next_scene_change_ = ready + kSceneChangeInterval;
  next_frame_s_ = 0.0;
  next_idle_frame_ = {};
  pending_tick_count_ = 0;
  wants_diagnostics_ = false;
  step_ms_sum_ = last_step_ms_ = 0.0;
  step_count_ = 0;
  last_passes_.clear();
  slow_since_ = {};
  recovery_news_.restart(stage_->water().recoveredCount());
  logged_recovery_count_ = stage_->water().recoveredCount();
  boats_ = stage_->boats();
  roster_.keepOnly({});  // the new scene's boats are nobody's yet, whatever their numbers
  publishSnapshot();
  spdlog::info("room {}: scene {}", name_, stage_->scene().name());
  observer.sceneChanged(*this);
  return {};
}

void Room::announceState(net::Hub& hub) {
  publishSnapshot();
  hub.broadcastControl(name_, stream::roomState(paused_, clock_.speed()));
}

void Room::announceBoats(net::Hub& hub) {
  const std::string before = boats_.SerializeAsString();
  boats_ = stage_->boats();
  if (boats_.SerializeAsString() == before) return;
  std::set<std::uint32_t> boat_ids;
  for (const v1::BoatInfo& boat : boats_.boats()) boat_ids.insert(boat.boat_id());
  roster_.keepOnly(boat_ids);
  publishSnapshot();
  hub.broadcastControl(name_, stream::boatList(boats_));
}

void Room::announceRecovery(TimePoint now, net::Hub& hub) {
  const std::uint64_t count = stage_->water().recoveredCount();
  if (!recovery_news_.tell(count, now)) return;
  hub.broadcastControl(
      name_,
      stream::roomEvent(v1::ROOM_EVENT_KIND_RECOVERED, tick(),
                        fmt::format("the guard put the water back to its last good state ({} times so far)", count)));
  announceBoats(hub);
}

}  // namespace spindrift::app
