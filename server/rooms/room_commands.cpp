// Carries out the commands of a room, dispatched by the table of kinds below. Every command gets one answer. All
// clients in the room are told the changes once per round, before the senders get their answers.
#include <algorithm>
#include <cassert>
#include <iterator>
#include <ranges>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <spindrift/rooms/room.h>
#include <spindrift/wire/client_message.h>

namespace spindrift::rooms {
namespace {

using namespace std::chrono_literals;

/// Limit of waiting ticks of Step: that of one command.
constexpr std::uint32_t kPendingTickMaxCount = 600;
/// Limit of batches per round; the rest waits for the next tick.
constexpr int kRoundMaxCount = 256;
/// When many clients join at once, they are announced in a few lists instead of one list each.
constexpr auto kPeopleNewsInterval = 200ms;

/// The rejection for a boat that belongs to another person or to none.
wire::CommandRejection notYours(std::string field, std::uint32_t boat_id, std::uint32_t owner_id) {
  return rejection(v1::REJECT_REASON_NOT_YOURS, std::move(field),
                   owner_id == 0 ? fmt::format("boat {} is nobody's: take it first", boat_id)
                                 : fmt::format("boat {} is person {}'s", boat_id, owner_id));
}

}  // namespace

/// A new command needs its message in wire.proto, a row here with a handler, and, if it has rules about the scene, a
/// case in wire::checkAgainstScene(). A handler gets commands that wire::completeCommand() accepted.
struct Room::CommandKind {
  v1::Command::ActionCase action;
  CommandTraits traits;
  /// Changes the water. Such commands are written to the log and replayed.
  RoomWater::Handler on_water;
  /// Carries the command out; null: on_water is all.
  Outcome (Room::*in_room)(const Command& command);
  /// Begins a batch whose commands are answered later; takes the place of in_room.
  void (Room::*begin)(Batch batch);
};

const Room::CommandKind& Room::kindOf(const v1::Command& command) {
  using C = v1::Command;
  constexpr auto kPlayer = core::Role::kPlayer;
  constexpr auto kOperator = core::Role::kOperator;
  constexpr bool kLight = false, kHeavy = true;
  constexpr bool kShared = true;
  static constexpr CommandKind kKinds[] = {
      {C::kSplash, {kPlayer, kLight}, &RoomWater::splash, nullptr, nullptr},
      {C::kBreakingWave, {kPlayer, kLight}, &RoomWater::breakingWave, nullptr, nullptr},
      {C::kSetParameter, {kOperator, kHeavy}, &RoomWater::setParameter, nullptr, &Room::setParameters},
      {C::kReset, {kOperator, kHeavy, kShared}, &RoomWater::reset, &Room::reset, nullptr},
      {C::kSetPaused, {kOperator, kLight}, nullptr, &Room::setPaused, nullptr},
      {C::kSetSpeed, {kOperator, kLight}, nullptr, &Room::setSpeed, nullptr},
      {C::kSpawnBoat, {kPlayer, kHeavy}, &RoomWater::spawnBoat, &Room::spawnBoat, nullptr},
      {C::kControlBoat, {kPlayer, kLight}, &RoomWater::controlBoat, &Room::controlBoat, nullptr},
      {C::kRemoveBoat, {kPlayer, kHeavy}, &RoomWater::removeBoat, &Room::removeBoat, nullptr},
      {C::kStep, {kOperator, kLight}, nullptr, &Room::advance, nullptr},
      {C::kChangeScene, {kOperator, kHeavy, kShared}, nullptr, nullptr, &Room::beginScene},
      {C::kTakeBoat, {kPlayer, kLight}, nullptr, &Room::takeBoat, nullptr},
  };
  const auto* kind = std::ranges::find(kKinds, command.action_case(), &CommandKind::action);
  assert(kind != std::end(kKinds));  // wire::checkCommand() rejects a command without an action
  return *kind;
}

const CommandTraits& traitsOf(const v1::Command& command) {
  return Room::kindOf(command).traits;
}

RoomWater::Handler RoomWater::handlerOf(const v1::Command& command) {
  return Room::kindOf(command).on_water;
}

std::optional<wire::CommandRejection> Room::admit(Command command) {
  const core::Sender& sender = command.sender;
  Outcome refused;
  if (const core::Role needed = traitsOf(command.message).role; sender.role < needed) {
    refused = rejection(
        v1::REJECT_REASON_FORBIDDEN, "",
        fmt::format("this takes the role of {}; yours is {}", core::roleName(needed), core::roleName(sender.role)));
  } else {
    const auto now = snapshot();
    refused = wire::completeCommand(command.message, now->scene);
    command.scene_version = now->scene_version;
  }
  const std::uint64_t command_id = command.id();
  if (!refused) {
    if (auto full = commands_.tryPush(std::move(command), std::chrono::steady_clock::now()))
      refused = rejection(v1::REJECT_REASON_BUSY, "", *std::move(full));
    else
      wake();
  }
  if (refused) refused->command_id = command_id;
  return refused;
}

void Room::applyCommands(TimePoint now) {
  using Clock = std::chrono::steady_clock;
  if (!change_ && heavy_budget_.isOpen(now)) {
    const auto begin = Clock::now();
    if (resumeValues()) heavy_budget_.spend(Clock::now() - begin);
  }
  for (int k = 0; k < kRoundMaxCount; ++k) {
    const bool may_be_heavy = !change_ && !put_off_ && heavy_budget_.isOpen(now);
    auto batch = commands_.next({.heavy = may_be_heavy, .scene_change = !build_});
    if (!batch) break;
    const bool is_heavy = traitsOf(batch->front().message).is_heavy;
    const auto begin = Clock::now();
    apply(*std::move(batch));
    if (is_heavy) heavy_budget_.spend(Clock::now() - begin);
  }
  answer(commands_.takeExpired(now),
         rejection(v1::REJECT_REASON_BUSY, "",
                   "the room is busy with resets, scenes, parameters and boats: try again in a second"));
}

void Room::abandonCommands() {
  const auto closed = rejection(v1::REJECT_REASON_BUSY, "", "the room was closed");
  if (build_) answer(std::move(build_->commands), closed);
  abandonChanges(closed);
  answer(commands_.drain(), closed);
  deliverAnswers();
}

void Room::apply(Batch batch) {
  const CommandKind& kind = kindOf(batch.front().message);
  if (kind.begin) return (this->*kind.begin)(std::move(batch));
  water_->fillIn(batch.front().message);
  Outcome outcome = checkAgain(batch.front());
  if (!outcome) outcome = kind.in_room ? (this->*kind.in_room)(batch.front()) : applyToWater(batch.front());
  answer(std::move(batch), outcome, std::exchange(new_boat_id_, 0));
}

Room::Outcome Room::checkAgain(const Command& command) const {
  if (command.scene_version == water_->sceneVersion()) return {};
  return wire::checkAgainstScene(command.message, water_->scene());
}

void Room::answer(Batch batch, const Outcome& outcome, std::uint32_t boat_id) {
  for (Command& command : batch) answers_.push_back({std::move(command), outcome, boat_id});
}

Room::Outcome Room::applyToWater(const Command& command) {
  if (auto refused = keep(command)) return refused;
  if (auto rejected = water_->apply(command.message)) return rejected;
  diary_.carriedOut(tick(), command.message);
  return {};
}

Room::Outcome Room::reset(const Command& command) {
  if (auto rejected = applyToWater(command)) return rejected;
  frames_.restart();
  frames_.setIdleDue({});
  time_.setSteps(0);
  news_.reset = true;
  boatsChanged();
  return {};
}

void Room::restartIfOver() {
  const double after_s = water_->scene().restart_after_s();
  if (after_s <= 0 || water_->sim().time_s() < after_s) return;
  Command again;
  again.message.mutable_reset();
  (void)reset(again);  // refused while the disk is full: tried again at the next tick
}

Room::Outcome Room::setPaused(const Command& command) {
  if (auto refused = keep(command)) return refused;
  time_.setPaused(command.message.set_paused().paused(), std::chrono::steady_clock::now());
  news_.state = true;
  return {};
}

Room::Outcome Room::setSpeed(const Command& command) {
  if (auto refused = keep(command)) return refused;
  time_.setSpeed(command.message.set_speed().speed());
  news_.state = true;
  return {};
}

// Boats

Room::Outcome Room::spawnBoat(const Command& command) {
  const core::Sender& sender = command.sender;
  if (sender.role < core::Role::kOperator && roster_.hasBoat(sender.person_id)) {
    return rejection(v1::REJECT_REASON_HAS_BOAT, "spawn_boat", "you have a boat: remove it before you launch another");
  }
  if (auto rejected = applyToWater(command)) return rejected;
  boatsChanged();
  new_boat_id_ = water_->spawnedBoatId();
  roster_.give(new_boat_id_, sender.person_id);
  return {};
}

Room::Outcome Room::controlBoat(const Command& command) {
  const std::uint32_t boat_id = command.message.control_boat().boat_id();
  const std::uint32_t owner_id = roster_.ownerOf(boat_id);
  const bool is_free_to_operators = owner_id == 0 && command.sender.role >= core::Role::kOperator;
  const bool is_own = owner_id != 0 && owner_id == command.sender.person_id;
  if (!is_own && !is_free_to_operators && isOnTheWater(boat_id)) {
    return notYours("control_boat.boat_id", boat_id, owner_id);
  }
  return applyToWater(command);
}

Room::Outcome Room::removeBoat(const Command& command) {
  const std::uint32_t boat_id = command.message.remove_boat().boat_id();
  const std::uint32_t owner_id = roster_.ownerOf(boat_id);
  const bool is_own = owner_id != 0 && owner_id == command.sender.person_id;
  if (!is_own && command.sender.role < core::Role::kOperator && isOnTheWater(boat_id)) {
    return notYours("remove_boat.boat_id", boat_id, owner_id);
  }
  if (auto rejected = applyToWater(command)) return rejected;
  boatsChanged();
  return {};
}

Room::Outcome Room::takeBoat(const Command& command) {
  const core::Sender& sender = command.sender;
  const std::uint32_t boat_id = command.message.take_boat().boat_id();
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
  return std::ranges::any_of(water_->sim().boats(),
                             [boat_id](const sim::BoatRecord& boat) { return boat.boat_id == boat_id; });
}

void Room::boatsChanged() {
  std::set<std::uint32_t> boat_ids;
  for (const sim::BoatRecord& boat : water_->sim().boats()) boat_ids.insert(boat.boat_id);
  roster_.keepOnly(boat_ids);
  news_.boats = true;
}

void Room::settlePeople(TimePoint now) {
  const Roster::Turn turn = roster_.settle(now);
  for (const std::uint32_t boat_id : turn.boats_to_stop) {
    Command stop;
    stop.message.mutable_control_boat()->set_boat_id(boat_id);
    (void)applyToWater(stop);  // the boat may be gone already
  }
  has_people_news_ = has_people_news_ || turn.is_news;
  if (!has_people_news_ || now < next_people_news_) return;
  has_people_news_ = false;
  next_people_news_ = now + kPeopleNewsInterval;
  outlets_.peopleChanged(*this, roster_.people());
}

// Time

Room::Outcome Room::advance(const Command& command) {
  const std::uint32_t tick_count = command.message.step().tick_count();
  if (!time_.isPaused()) {
    return rejection(v1::REJECT_REASON_OUT_OF_RANGE, "step", "the room is running; pause it first, then step");
  }
  if (time_.stepsToCome() + tick_count > kPendingTickMaxCount) {
    return rejection(v1::REJECT_REASON_BUSY, "step.tick_count",
                     fmt::format("{} ticks more than the {} still to come are above {}; try again when they are done",
                                 tick_count, time_.stepsToCome(), kPendingTickMaxCount));
  }
  if (auto refused = keep(command)) return refused;
  time_.setSteps(time_.stepsToCome() + tick_count);
  return {};
}

// News

void Room::announce() {
  const News news = std::exchange(news_, {});
  if (news.state || !news.parameters.empty()) publishSnapshot();
  if (news.state) outlets_.timeChanged(*this, time_.isPaused(), time_.speed());
  for (const auto& [path, value] : news.parameters) outlets_.parameterChanged(*this, path, value);
  if (news.reset) outlets_.wasReset(*this);
  if (!news.rebuilt.empty()) outlets_.hasRecovered(*this, news.rebuilt);
  if (news.boats) announceBoats();
  diary_.people(tick(), roster_);
  flushKept();
  deliverAnswers();
}

void Room::deliverAnswers() {
  for (Answer& one : std::exchange(answers_, {})) {
    if (one.rejected) {
      one.rejected->command_id = one.command.id();
      outlets_.commandRejected(one.command, *one.rejected);
    } else {
      outlets_.commandApplied(one.command, tick(), one.boat_id);
    }
  }
}

void Room::announceBoats() {
  const std::string before = boats_.SerializeAsString();
  boats_ = water_->boats();
  if (boats_.SerializeAsString() == before) return;
  publishSnapshot();
  outlets_.boatsChanged(*this, boats_);
}

void Room::announceRecovery(TimePoint now) {
  const std::uint64_t count = water_->sim().recoveredCount();
  if (!recovery_news_.tell(count, now)) return;
  outlets_.hasRecovered(*this,
                        fmt::format("the watchdog put the water back to its last good state ({} times so far)", count));
  boatsChanged();
}

}  // namespace spindrift::rooms
