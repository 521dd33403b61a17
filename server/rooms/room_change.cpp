// Parameter changes of a room. Most take effect at once. A change of the number of particles is prepared on another
// thread while the room's ticks wait, so that other rooms and this room's frames and answers continue.
#include <iterator>
#include <ranges>
#include <utility>
#include <variant>

#include <spindrift/rooms/room.h>

namespace spindrift::rooms {

using namespace std::chrono_literals;

namespace {

/// Values that one piece of work tries: a value that the water refuses costs 3 to 5 ms, and a sender may have 64
/// waiting.
constexpr int kTriedMaxCount = 8;

}  // namespace

void Room::applyNewest(Values values) {
  bool is_taken = false;
  for (int k = 0; !values.untried.empty() && !is_taken; ++k) {
    if (k == kTriedMaxCount) return putOff(std::move(values));
    core::Command command = std::move(values.untried.back());
    values.untried.pop_back();
    const auto* change = std::get_if<core::SetParameter>(&command.action);
    Outcome outcome = change ? refuseChange(command, *change) : apply(command);
    if (change && !outcome) {
      if (beginChange(command, values)) return;
      outcome = applyToWater(command);
      if (!outcome) parameterChanged(*change);
    }
    is_taken = !outcome;
    const bool is_spawn = std::holds_alternative<core::SpawnBoat>(command.action);
    values.tried.push_back(
        {std::move(command), std::move(outcome), is_taken && is_spawn ? stage_->spawnedBoatId() : 0});
  }
  conclude(std::move(values));
}

void Room::putOff(Values values) {
  commands_.hold(values.untried);
  put_off_.emplace(std::move(values));
}

bool Room::resumeValues() {
  if (!put_off_) return false;
  Values values = *std::move(put_off_);
  put_off_.reset();
  commands_.release(values.untried);
  applyNewest(std::move(values));
  return true;
}

void Room::conclude(Values values) {
  answer(std::move(values.untried), {});
  std::ranges::move(values.tried | std::views::reverse, std::back_inserter(answers_));
}

bool Room::beginChange(const core::Command& command, Values& others) {
  auto relayout = stage_->relayout(command.action);
  if (!relayout) return false;
  auto prepared = builder_.prepare(relayout->wanted, std::exchange(relayout->basis, {}));
  commands_.hold({command});
  change_.emplace(
      Change{command, std::move(others), *std::move(relayout), std::move(prepared), std::chrono::steady_clock::now()});
  return true;
}

void Room::finishChange() {
  if (!change_ || change_->prepared.wait_for(0s) != std::future_status::ready) return;
  Change change = *std::move(change_);
  change_.reset();
  commands_.release({change.command});
  Outcome outcome = stage_->adopt(std::move(change.relayout), change.prepared.get());
  heavy_budget_.spend(std::chrono::steady_clock::now() - change.begin);
  const bool is_taken = !outcome;
  if (is_taken) {
    recordCommand(change.command);
    parameterChanged(std::get<core::SetParameter>(change.command.action));
  }
  change.others.tried.push_back({std::move(change.command), std::move(outcome)});
  if (is_taken) return conclude(std::move(change.others));
  applyNewest(std::move(change.others));
}

void Room::abandonChanges(const wire::CommandRejection& rejection) {
  const auto abandon = [&](Values values) {
    commands_.release(values.untried);
    answer(std::exchange(values.untried, {}), rejection);
    conclude(std::move(values));
  };
  if (change_) {
    Change change = *std::move(change_);
    change_.reset();
    commands_.release({change.command});
    change.others.tried.push_back({std::move(change.command), rejection});
    abandon(std::move(change.others));
  }
  if (put_off_) abandon(*std::exchange(put_off_, std::nullopt));
}

Room::Outcome Room::refuseChange(const core::Command& command, const core::SetParameter& change) const {
  // Checked when it arrived, but the scene may have changed since.
  if (auto rejected = wire::checkAgainstScene(command, stage_->scene())) return rejected;
  const auto wanted = stage_->workWith(change);
  if (!wanted) return {};
  return refuseSlow(command.sender, change.path, tick_cost_.predict_ms(stage_->work(), *wanted), kTickMax_ms);
}

void Room::parameterChanged(const core::SetParameter& change) {
  next_frame_s_ = 0.0;  // the frame rate may have changed; by the old rate the next frame could be up to a second away
  news_.parameters[change.path] = change.value;
}

}  // namespace spindrift::rooms
