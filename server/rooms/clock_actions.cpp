// Actions of the room's time: pause, speed, steps, and the clock that people hold. Neither logs nor snapshots have
// holders: a room that starts again runs by itself.
#include <algorithm>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <spindrift/rooms/room_actions.h>

namespace spindrift::rooms {
namespace {

using Clock = std::chrono::steady_clock;

/// Limit of waiting ticks of Step: that of one command.
constexpr std::uint32_t kPendingTickMaxCount = 600;

wire::CommandRejection tooManyTicks(std::uint32_t tick_count, std::uint32_t to_come) {
  return wire::rejection(v1::REJECT_REASON_BUSY, "step.tick_count",
                         fmt::format("{} ticks more than the {} still to come are above {}; try again when they are "
                                     "done",
                                     tick_count, to_come, kPendingTickMaxCount));
}

}  // namespace

std::string RoomActions::holderNames() const {
  std::vector<std::string> names;
  for (const HeldClock::Holder& holder : room_.clock.holders()) names.push_back(holder.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

RoomActions::Outcome RoomActions::refuseHeld(const char* field) const {
  if (!room_.clock.isHeld()) return {};
  return wire::rejection(v1::REJECT_REASON_CLOCK_HELD, field,
                         fmt::format("the room's clock is held by {}: it advances by their steps only, until they "
                                     "release it or an operator does (release_clock)",
                                     holderNames()));
}

// Pause, speed, steps

RoomActions::Outcome RoomActions::setPaused(const Command& command) {
  if (auto held = refuseHeld("set_paused")) return held;
  if (auto refused = writeAhead(command)) return refused;
  room_.time.setPaused(command.message.set_paused().paused(), Clock::now());
  room_.steps.endAll("the room was paused anew, or runs again: the steps have ended");
  room_.news.state = true;
  room_.news.state_person_id = command.sender.person_id;
  return {};
}

RoomActions::Outcome RoomActions::setSpeed(const Command& command) {
  if (auto held = refuseHeld("set_speed")) return held;
  if (auto refused = writeAhead(command)) return refused;
  room_.time.setSpeed(command.message.set_speed().speed());
  room_.news.state = true;
  room_.news.state_person_id = command.sender.person_id;
  return {};
}

RoomActions::Outcome RoomActions::advance(const Command& command) {
  const v1::Step& step = command.message.step();
  if (step.waits() && room_.steps.isFull(command.sender)) {
    return wire::rejection(v1::REJECT_REASON_BUSY, "step.waits",
                           fmt::format("{} steps wait for their ticks, which is the most: wait for the answer to one",
                                       kWaitingStepMaxCount));
  }
  if (const HeldClock::Holder* holder = room_.clock.find(command.sender)) {
    if (holder->ticks_to_come + step.tick_count() > kPendingTickMaxCount)
      return tooManyTicks(step.tick_count(), holder->ticks_to_come);
    if (room_.clock.ticksToCome() == 0) room_.time.holdFrom(Clock::now());
    room_.clock.ask(command.sender, step.tick_count());
    if (step.waits()) room_.steps.enter(command, room_.clock.find(command.sender)->ticks_to_come);
    return {};
  }
  if (command.sender.role < core::Role::kOperator) {
    return wire::rejection(v1::REJECT_REASON_FORBIDDEN, "",
                           fmt::format("this takes the role of {}, or the room's clock (take_clock); your role is {}",
                                       core::roleName(core::Role::kOperator), core::roleName(command.sender.role)));
  }
  if (auto held = refuseHeld("step")) return held;
  RoomTime& time = room_.time;
  if (!time.isPaused()) {
    return wire::rejection(v1::REJECT_REASON_OUT_OF_RANGE, "step",
                           "the room is running; pause it first, or take its clock, then step");
  }
  if (time.stepsToCome() + step.tick_count() > kPendingTickMaxCount)
    return tooManyTicks(step.tick_count(), time.stepsToCome());
  if (auto refused = writeAhead(command)) return refused;
  time.setSteps(time.stepsToCome() + step.tick_count());
  if (step.waits()) room_.steps.enter(command, time.stepsToCome());
  return {};
}

// The clock

RoomActions::Outcome RoomActions::takeClock(const Command& command) {
  const core::Sender& who = command.sender;
  if (!room_.roster.isConnected(who.person_id, who.session_id)) {
    return wire::rejection(v1::REJECT_REASON_FORBIDDEN, "take_clock",
                           "only somebody in the room's list of people can hold its clock: connect by WebSocket");
  }
  if (who.role < core::Role::kOperator && room_.roster.hasActorsBeside(who.person_id)) {
    return wire::rejection(v1::REJECT_REASON_FORBIDDEN, "take_clock",
                           "the role of player takes the clock only while nobody else in the room may act: open a "
                           "room of your own, or ask for the role of operator");
  }
  const v1::TakeClock& asked = command.message.take_clock();
  const bool was_held = room_.clock.isHeld();
  const bool had_it = room_.clock.find(who) != nullptr;
  const auto now = Clock::now();
  const std::string name = room_.roster.nameOf(who.person_id);
  if (!room_.clock.take(who, name, {.speed = asked.speed(), .timeout_s = asked.timeout_s()}, now)) {
    return wire::rejection(v1::REJECT_REASON_BUSY, "take_clock",
                           fmt::format("the clock has {} holders, which is the most", kClockHolderMaxCount));
  }
  if (!was_held) {
    room_.time.setSteps(0);
    room_.steps.endAll("the room's clock was taken: the steps have ended");
    room_.time.setHeld(true, now);
  }
  if (!had_it) tellClock(name + " holds the clock", who.person_id);
  return {};
}

RoomActions::Outcome RoomActions::releaseClock(const Command& command) {
  const core::Sender& who = command.sender;
  if (room_.clock.find(who)) {
    loseClock([&](const HeldClock::Holder& holder) { return holder.who.session_id == who.session_id; },
              "gave the clock back", who.person_id);
    return {};
  }
  if (!room_.clock.isHeld())
    return wire::rejection(v1::REJECT_REASON_OUT_OF_RANGE, "release_clock", "nobody holds the room's clock");
  if (who.role < core::Role::kOperator) {
    return wire::rejection(
        v1::REJECT_REASON_NOT_YOURS, "release_clock",
        fmt::format("the clock is held by {}; only they and operators can release it", holderNames()));
  }
  loseClock([](const HeldClock::Holder&) { return true; }, "lost the clock: an operator released it", who.person_id);
  return {};
}

void RoomActions::reviewClock(TimePoint now, const std::function<bool(const core::Sender&)>& is_busy) {
  if (!room_.clock.isHeld()) return;
  const Roster& roster = room_.roster;
  const auto is_gone = [&](const HeldClock::Holder& holder) {
    return !roster.isConnected(holder.who.person_id, holder.who.session_id);
  };
  const auto has_company = [&](const HeldClock::Holder& holder) {
    return holder.who.role < core::Role::kOperator && roster.hasActorsBeside(holder.who.person_id);
  };
  loseClock(is_gone, "lost the clock: the connection ended", 0);
  loseClock(has_company, "lost the clock: somebody else came, and the role of player holds it alone only", 0);
  // Its next Step may wait behind what the room does for it.
  for (const HeldClock::Holder& holder : std::vector(room_.clock.holders())) {
    if (is_busy(holder.who)) room_.clock.excuse(holder.who, now);
  }
  loseClock([&](const HeldClock::Holder& holder) { return HeldClock::isSilent(holder, now); },
            "lost the clock: no step came within its time-out", 0);
}

void RoomActions::dropSteps(const std::string& why) {
  room_.time.setSteps(0);
  room_.clock.dropTicks(Clock::now());
  room_.steps.endAll(why);
}

void RoomActions::loseClock(const std::function<bool(const HeldClock::Holder&)>& holds, const std::string& how,
                            std::uint32_t person_id) {
  for (const HeldClock::Holder& holder : room_.clock.removeIf(holds)) {
    room_.steps.endIf("you do not hold the room's clock any more: the steps have ended",
                      [&](const core::Sender& sender) { return sender.session_id == holder.who.session_id; });
    tellClock(holder.name + " " + how, person_id);
    if (!room_.clock.isHeld()) room_.time.setHeld(false, Clock::now());
  }
}

void RoomActions::tellClock(const std::string& what, std::uint32_t person_id) {
  News& news = room_.news;
  news.clock += (news.clock.empty() ? "" : "; ") + what;
  news.clock_person_id = person_id;
  news.state = true;
  news.state_person_id = person_id;
}

}  // namespace spindrift::rooms
