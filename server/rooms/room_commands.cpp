// Carries out the commands of a room. Every command gets one answer. All clients in the room are told the changes once
// per round, before the senders get their answers.
#include <algorithm>
#include <iterator>
#include <ranges>
#include <set>
#include <utility>
#include <variant>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <spindrift/core/overloaded.h>
#include <spindrift/rooms/room.h>
#include <spindrift/wire/client_message.h>

namespace spindrift::rooms {
namespace {

using namespace std::chrono_literals;

/// Limit of waiting ticks of Step: as many as one command may request.
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

std::optional<wire::CommandRejection> Room::admit(core::Command command) {
  const core::Sender& sender = command.sender;
  Outcome refused;
  if (const core::Role needed = core::roleFor(command.action); sender.role < needed) {
    refused = rejection(
        v1::REJECT_REASON_FORBIDDEN, "",
        fmt::format("this takes the role of {}; yours is {}", core::roleName(needed), core::roleName(sender.role)));
  } else {
    refused = wire::checkAgainstScene(command, snapshot()->scene);
  }
  const std::uint64_t command_id = command.command_id;
  if (!refused) {
    if (auto full = commands_.tryPush(std::move(command), std::chrono::steady_clock::now()))
      refused = rejection(v1::REJECT_REASON_BUSY, "", *std::move(full));
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
    const bool is_heavy = isHeavy(batch->front().action);
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
  if (std::holds_alternative<core::ChangeScene>(batch.front().action)) return beginScene(std::move(batch));
  if (std::holds_alternative<core::Reset>(batch.front().action)) {
    const Outcome outcome = apply(batch.front());
    return answer(std::move(batch), outcome);
  }
  applyNewest({.untried = std::move(batch), .tried = {}});
}

void Room::answer(Batch batch, const Outcome& outcome) {
  for (core::Command& command : batch) answers_.push_back({std::move(command), outcome});
}

Room::Outcome Room::apply(const core::Command& command) {
  // Checked against the scene when it arrived, but the scene may have changed since.
  if (auto rejected = wire::checkAgainstScene(command, stage_->scene())) return rejected;
  return std::visit(
      core::Overloaded{[&](const core::Splash&) { return applyToWater(command); },
                       [&](const core::BreakingWave&) { return applyToWater(command); },
                       // applyNewest() handles them.
                       [&](const core::SetParameter&) -> Outcome { return {}; },
                       [&](const core::Reset&) { return reset(command); },
                       [&](const core::SetPaused& pause) { return setPaused(pause.paused); },
                       [&](const core::SetSpeed& speed) -> Outcome {
                         clock_.setSpeed(speed.speed);
                         news_.state = true;
                         return {};
                       },
                       [&](const core::SpawnBoat&) { return spawnBoat(command); },
                       [&](const core::ControlBoat& control) { return controlBoat(command, control.boat_id); },
                       [&](const core::RemoveBoat& remove) { return removeBoat(command, remove.boat_id); },
                       [&](const core::TakeBoat& take) { return takeBoat(command.sender, take.boat_id); },
                       [&](const core::Step& step) { return advance(step); },
                       // Handled by apply(Batch), which calls beginScene().
                       [&](const core::ChangeScene&) -> Outcome { return {}; }},
      command.action);
}

Room::Outcome Room::applyToWater(const core::Command& command) {
  if (auto rejected = stage_->apply(command.action)) return rejected;
  recordCommand(command);
  return {};
}

void Room::recordCommand(const core::Command& command) {
  if (!log_) return;
  v1::Record line;
  *line.mutable_command() = wire::toWire(command);
  record(std::move(line));
}

Room::Outcome Room::reset(const core::Command& command) {
  if (auto rejected = applyToWater(command)) return rejected;
  next_frame_s_ = 0.0;
  next_idle_frame_ = {};
  pending_tick_count_ = 0;
  news_.reset = true;
  boatsChanged();
  return {};
}

Room::Outcome Room::setPaused(bool paused) {
  if (paused_ && !paused) clock_.restart(std::chrono::steady_clock::now());
  paused_ = paused;
  pending_tick_count_ = 0;
  news_.state = true;
  return {};
}

// Boats

Room::Outcome Room::spawnBoat(const core::Command& command) {
  const core::Sender& sender = command.sender;
  if (sender.role < core::Role::kOperator && roster_.hasBoat(sender.person_id)) {
    return rejection(v1::REJECT_REASON_HAS_BOAT, "spawn_boat", "you have a boat: remove it before you launch another");
  }
  if (auto rejected = applyToWater(command)) return rejected;
  boatsChanged();
  roster_.give(stage_->spawnedBoatId(), sender.person_id);
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

Room::Outcome Room::removeBoat(const core::Command& command, std::uint32_t boat_id) {
  const std::uint32_t owner_id = roster_.ownerOf(boat_id);
  const bool is_own = owner_id != 0 && owner_id == command.sender.person_id;
  if (!is_own && command.sender.role < core::Role::kOperator && isOnTheWater(boat_id)) {
    return notYours("remove_boat.boat_id", boat_id, owner_id);
  }
  if (auto rejected = applyToWater(command)) return rejected;
  boatsChanged();
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
  return std::ranges::any_of(stage_->water().boats(),
                             [boat_id](const sim::BoatRecord& boat) { return boat.boat_id == boat_id; });
}

void Room::boatsChanged() {
  std::set<std::uint32_t> boat_ids;
  for (const sim::BoatRecord& boat : stage_->water().boats()) boat_ids.insert(boat.boat_id);
  roster_.keepOnly(boat_ids);
  news_.boats = true;
}

void Room::settlePeople(TimePoint now) {
  const Roster::Turn turn = roster_.settle(now);
  for (const std::uint32_t boat_id : turn.boats_to_stop) {
    (void)applyToWater({.action = core::ControlBoat{.boat_id = boat_id}});  // the boat may be gone already
  }
  has_people_news_ = has_people_news_ || turn.is_news;
  if (!has_people_news_ || now < next_people_news_) return;
  has_people_news_ = false;
  next_people_news_ = now + kPeopleNewsInterval;
  outlets_.peopleChanged(*this, roster_.people());
}

// Time

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

// News

void Room::announce() {
  const News news = std::exchange(news_, {});
  if (news.state || !news.parameters.empty()) publishSnapshot();
  if (news.state) outlets_.timeChanged(*this, paused_, clock_.speed());
  for (const auto& [path, value] : news.parameters) outlets_.parameterChanged(*this, path, value);
  if (news.reset) outlets_.wasReset(*this);
  if (news.rebuilt) outlets_.hasRecovered(*this, "the device failed; the scene began again on a new one");
  if (news.boats) announceBoats();
  deliverAnswers();
}

void Room::deliverAnswers() {
  for (Answer& one : std::exchange(answers_, {})) {
    if (one.rejected) {
      one.rejected->command_id = one.command.command_id;
      outlets_.commandRejected(one.command, *one.rejected);
    } else {
      outlets_.commandApplied(one.command, tick(), one.boat_id);
    }
  }
}

void Room::announceBoats() {
  const std::string before = boats_.SerializeAsString();
  boats_ = stage_->boats();
  if (boats_.SerializeAsString() == before) return;
  publishSnapshot();
  outlets_.boatsChanged(*this, boats_);
}

void Room::announceRecovery(TimePoint now) {
  const std::uint64_t count = stage_->water().recoveredCount();
  if (!recovery_news_.tell(count, now)) return;
  outlets_.hasRecovered(*this,
                        fmt::format("the watchdog put the water back to its last good state ({} times so far)", count));
  boatsChanged();
}

}  // namespace spindrift::rooms
