#include <algorithm>
#include <cassert>
#include <chrono>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include <spindrift/classroom/lesson.h>
#include <spindrift/rooms/command_desk.h>
#include <spindrift/wire/client_message.h>

namespace spindrift::rooms {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

/// Share of the wall time that heavy commands may take, and how much of it at once: ticks come first.
constexpr double kHeavyShare = 0.25;
constexpr auto kHeavyBurst = 30ms;
/// Limit of batches per round; the rest waits for the next tick.
constexpr int kRoundMaxCount = 256;
/// Values that one piece of work tries: a value that the water refuses costs 3 to 5 ms, and a sender may have 64
/// waiting.
constexpr int kTriedMaxCount = 8;

}  // namespace

/// A new command needs its message in wire.proto, a row here with a handler, and, if it has rules about the scene, a
/// case in wire::checkAgainstScene(). A handler gets commands that wire::completeCommand() accepted.
struct CommandDesk::Kind {
  v1::Command::ActionCase action;
  CommandTraits traits;
  /// Carries the command out; null: it only changes the water (RoomWater::handlerOf()).
  Outcome (RoomActions::*in_room)(const Command& command);
  /// Begins a batch whose commands are answered later; takes the place of in_room.
  void (CommandDesk::*begin)(Batch batch);
};

const CommandDesk::Kind& CommandDesk::kindOf(const v1::Command& command) {
  using C = v1::Command;
  using Act = RoomActions;
  using Desk = CommandDesk;
  constexpr auto kViewer = core::Role::kViewer;
  constexpr auto kPlayer = core::Role::kPlayer;
  constexpr auto kOperator = core::Role::kOperator;
  constexpr bool kLight = false, kHeavy = true;
  constexpr bool kShared = true;
  static constexpr Kind kKinds[] = {
      {C::kSplash, {kPlayer, kLight}, nullptr, nullptr},
      {C::kBreakingWave, {kPlayer, kLight}, nullptr, nullptr},
      {C::kStroke, {kPlayer, kLight}, &Act::draw, nullptr},
      {C::kSetParameter, {kOperator, kHeavy}, nullptr, &Desk::setParameters},
      {C::kReset, {kOperator, kHeavy, kShared}, &Act::reset, nullptr},
      {C::kSetPaused, {kOperator, kLight}, &Act::setPaused, nullptr},
      {C::kSetSpeed, {kOperator, kLight}, &Act::setSpeed, nullptr},
      {C::kSpawnBoat, {kPlayer, kHeavy}, &Act::spawnBoat, nullptr},
      {C::kControlBoat, {kPlayer, kLight}, &Act::controlBoat, nullptr},
      {C::kRemoveBoat, {kPlayer, kHeavy}, &Act::removeBoat, nullptr},
      {C::kStep, {kPlayer, kLight}, nullptr, &Desk::beginStep},  // of operators and holders of the clock
      {C::kChangeScene, {kOperator, kHeavy, kShared}, nullptr, &Desk::beginScene},
      {C::kTakeBoat, {kPlayer, kLight}, &Act::takeBoat, nullptr},
      {C::kSpawnFloater, {kPlayer, kLight}, &Act::spawnFloater, nullptr},
      {C::kHoldFloater, {kPlayer, kLight}, &Act::holdFloater, nullptr},
      {C::kRemoveFloater, {kPlayer, kLight}, &Act::removeFloater, nullptr},
      {C::kSetLesson, {kOperator, kLight}, &Act::setLesson, nullptr},
      {C::kMutePerson, {kOperator, kLight}, &Act::mutePerson, nullptr},
      {C::kSetTeam, {kOperator, kLight}, &Act::setTeam, nullptr},
      {C::kStartGame, {kOperator, kLight}, &Act::startGame, nullptr},
      {C::kEndGame, {kOperator, kLight}, &Act::endGame, nullptr},
      {C::kPlaceGauge, {kPlayer, kLight}, &Act::placeGauge, nullptr},
      {C::kRemoveGauge, {kPlayer, kLight}, &Act::removeGauge, nullptr},
      {C::kQuery, {kViewer, kLight}, &Act::ask, nullptr},
      {C::kTakeClock, {kPlayer, kLight}, &Act::takeClock, nullptr},
      {C::kReleaseClock, {kPlayer, kLight}, &Act::releaseClock, nullptr},
  };
  const auto* kind = std::ranges::find(kKinds, command.action_case(), &Kind::action);
  assert(kind != std::end(kKinds));  // wire::checkCommand() rejects a command without an action
  return *kind;
}

const CommandTraits& traitsOf(const v1::Command& command) {
  return CommandDesk::kindOf(command).traits;
}

core::Role roleFor(const v1::Command& command) {
  const bool removes_all = command.remove_floater().all();
  const bool calms = command.stroke().tool() == v1::STROKE_TOOL_CALM;
  return removes_all || calms ? core::Role::kOperator : traitsOf(command).role;
}

CommandDesk::CommandDesk(RoomData& room, RoomActions& actions, WaterChange& change)
    : room_(room), actions_(actions), change_(change), heavy_budget_(kHeavyShare, kHeavyBurst) {}

CommandDesk::Outcome CommandDesk::admit(Command command, const RoomSnapshot& room) {
  const core::Sender& sender = command.sender;
  const std::uint64_t command_id = command.id();
  Outcome refused;
  if (const core::Role needed = roleFor(command.message); sender.role < needed) {
    refused = wire::rejection(
        v1::REJECT_REASON_FORBIDDEN, "",
        fmt::format("this takes the role of {}; yours is {}", core::roleName(needed), core::roleName(sender.role)));
  } else if (refused = room_.roster.refuse(sender, command.message); !refused) {
    const v1::Boat& boat = command.message.spawn_boat().boat();
    command.is_placed_by_room = command.message.has_spawn_boat() && !boat.has_x_m() && !boat.has_z_m();
    refused = wire::completeCommand(command.message, room.scene);
    command.scene_version = room.scene_version;
  }
  if (!refused) {
    if (auto full = queue_.tryPush(std::move(command), Clock::now()))
      refused = wire::rejection(v1::REJECT_REASON_BUSY, "", *std::move(full));
  }
  if (refused) refused->set_command_id(command_id);
  return refused;
}

// Carrying out

void CommandDesk::carryOut(TimePoint now) {
  const auto spend = [this](auto&& work) {
    const auto begin = Clock::now();
    work();
    heavy_budget_.spend(Clock::now() - begin);
  };
  if (values_ && !values_->relaid && heavy_budget_.isOpen(now)) spend([this] { tryNewest(resume()); });
  for (int k = 0; k < kRoundMaxCount; ++k) {
    const bool may_be_heavy = !values_ && heavy_budget_.isOpen(now);
    auto batch = queue_.next(
        {.heavy = may_be_heavy, .scene_change = change_.mayBuild(), .joined_values = !room_.clock.isHeld()});
    if (!batch) break;
    if (traitsOf(batch->front().message).is_heavy)
      spend([&] { apply(*std::move(batch)); });
    else
      apply(*std::move(batch));
  }
  // With a held clock the same commands have the same outcome on a busy machine, too: they wait.
  if (room_.clock.isHeld()) return;
  answer(queue_.takeExpired(now),
         wire::rejection(v1::REJECT_REASON_BUSY, "",
                         "the room is busy with resets, scenes, parameters and boats: try again in a second"));
}

void CommandDesk::apply(Batch batch) {
  const Kind& kind = kindOf(batch.front().message);
  if (kind.begin) return (this->*kind.begin)(std::move(batch));
  Command& first = batch.front();
  room_.water->fillIn(first.message);
  Outcome outcome = checkAgain(first);
  if (!outcome) outcome = room_.roster.refuse(first.sender, first.message);  // the lesson may have changed meanwhile
  if (!outcome) {
    if (first.sender.role < core::Role::kOperator) limitForce(room_.roster.forceRatio(), first.message);
    outcome = kind.in_room ? (actions_.*kind.in_room)(first) : actions_.applyToWater(first);
  }
  answer(std::move(batch), outcome, actions_.takeNewIds());
}

CommandDesk::Outcome CommandDesk::checkAgain(const Command& command) const {
  if (command.scene_version == room_.water->sceneVersion()) return {};
  return wire::checkAgainstScene(command.message, room_.water->scene());
}

// Steps

void CommandDesk::beginStep(Batch batch) {
  const Command& step = batch.front();
  Outcome outcome = room_.roster.refuse(step.sender, step.message);
  if (!outcome) outcome = actions_.advance(step);
  if (outcome || !step.message.step().waits()) answer(std::move(batch), outcome);
}

void CommandDesk::finishSteps() {
  std::vector<Command> done = room_.steps.takeDone();
  if (done.empty()) return;
  room_.water->takeHealth();
  v1::Ack ack;
  ack.set_state_hash(room_.water->sim().stateHash());
  answer(std::move(done), {}, ack);
  sendAnswers();
}

// Scenes

void CommandDesk::beginScene(Batch batch) {
  if (const auto outcome = change_.beginScene(batch.front())) return answer(std::move(batch), *outcome);
  queue_.hold(batch);
  scene_batch_ = std::move(batch);
}

void CommandDesk::sceneChanged(const Outcome& outcome) {
  queue_.release(scene_batch_);
  const v1::Command wanted = scene_batch_.front().message;
  answer(std::exchange(scene_batch_, {}), outcome);
  if (!outcome) answer(queue_.takeEqual(wanted), {});
}

// Parameters

void CommandDesk::tryNewest(Values values) {
  for (int k = 0; k < kTriedMaxCount && !values.untried.empty(); ++k) {
    Command command = std::move(values.untried.back());
    values.untried.pop_back();
    Outcome outcome = refuseValue(command);
    if (!outcome && change_.beginRelayout(command.message.set_parameter())) {
      values.relaid = std::move(command);
      values.begin = Clock::now();
      return putOff(std::move(values));
    }
    if (!outcome) outcome = actions_.applyToWater(command);
    const bool is_taken = !outcome;
    if (is_taken) actions_.parameterChanged(command.message.set_parameter());
    values.tried.push_back({std::move(command), std::move(outcome)});
    if (is_taken) return conclude(std::move(values));
  }
  if (values.untried.empty()) return conclude(std::move(values));
  putOff(std::move(values));
}

void CommandDesk::putOff(Values values) {
  queue_.hold(values.relaid ? Batch{*values.relaid} : values.untried);
  values_.emplace(std::move(values));
}

CommandDesk::Values CommandDesk::resume() {
  Values values = *std::exchange(values_, std::nullopt);
  queue_.release(values.relaid ? Batch{*values.relaid} : values.untried);
  return values;
}

void CommandDesk::conclude(Values values) {
  answer(std::move(values.untried), {});
  answers_.insert(answers_.end(), std::make_move_iterator(values.tried.rbegin()),
                  std::make_move_iterator(values.tried.rend()));
}

void CommandDesk::finishRelayout() {
  const auto outcome = change_.takeLayout();
  if (!outcome) return;
  Values values = resume();
  Command command = *std::exchange(values.relaid, std::nullopt);
  heavy_budget_.spend(Clock::now() - values.begin);
  const bool is_taken = !*outcome;
  if (is_taken) {
    room_.diary.carriedOutLate(command.message);
    actions_.parameterChanged(command.message.set_parameter());
  }
  values.tried.push_back({std::move(command), *outcome});
  if (is_taken) return conclude(std::move(values));
  tryNewest(std::move(values));
}

CommandDesk::Outcome CommandDesk::refuseValue(const Command& command) const {
  if (auto rejected = checkAgain(command)) return rejected;
  const v1::SetParameter& change = command.message.set_parameter();
  const auto wanted = room_.water->workWith(change);
  if (!wanted) return {};
  return change_.refuseSlow(command.sender, change.path(), room_.tick_cost.predict_ms(*wanted), water::kTickMax_ms);
}

// Answers

void CommandDesk::answer(Batch batch, const Outcome& outcome, const v1::Ack& ack) {
  for (Command& command : batch) answers_.push_back({std::move(command), outcome, ack});
}

void CommandDesk::rejectAll(const wire::CommandRejection& rejection) {
  if (values_) {
    Values values = resume();
    change_.abandonLayout();
    if (values.relaid) values.tried.push_back({*std::exchange(values.relaid, std::nullopt), rejection});
    answer(std::exchange(values.untried, {}), rejection);
    conclude(std::move(values));
  }
  answer(queue_.drain(), rejection);
}

void CommandDesk::close() {
  const auto closed = wire::rejection(v1::REJECT_REASON_BUSY, "", "the room was closed");
  answer(std::exchange(scene_batch_, {}), closed);
  room_.steps.endAll("the room was closed");
  rejectAll(closed);
  sendAnswers();
}

void CommandDesk::sendAnswers() {
  for (StepBook::Ended& ended : room_.steps.takeEnded()) {
    const auto not_now = wire::rejection(v1::REJECT_REASON_NOT_NOW, "step", std::move(ended.why));
    answers_.push_back({std::move(ended.command), not_now});
  }
  std::vector<Answer> answers = std::exchange(answers_, {});
  // A rejection promises nothing, and does not wait for the disk.
  const bool promises = std::ranges::any_of(answers, [](const Answer& one) { return !one.rejected; });
  const auto kept = promises ? room_.diary.flush() : core::Result<void>();
  for (Answer& one : answers) {
    if (!one.rejected && !kept) {
      one.rejected =
          wire::rejection(v1::REJECT_REASON_BUSY, "",
                          "it was carried out, but the server cannot keep it on disk: " + kept.error().message);
    }
    if (one.rejected) {
      one.rejected->set_command_id(one.command.id());
      room_.outlets.commandRejected(one.command, *one.rejected);
    } else {
      one.ack.set_command_id(one.command.id());
      one.ack.set_applied_tick(room_.water->tick());
      room_.outlets.commandApplied(one.command, one.ack);
    }
  }
}

}  // namespace spindrift::rooms
