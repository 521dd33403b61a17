// Parameter changes of a room. Most take effect at once. A change of the number of particles is prepared on another
// thread while the room's ticks wait, so that other rooms and this room's frames and answers continue.
#include <iterator>
#include <utility>

#include <spindrift/rooms/room.h>

namespace spindrift::rooms {

using namespace std::chrono_literals;

namespace {

/// Values that one piece of work tries: a value that the water refuses costs 3 to 5 ms, and a sender may have 64
/// waiting.
constexpr int kTriedMaxCount = 8;

}  // namespace

void Room::setParameters(Batch values) {
  applyNewest({.untried = std::move(values), .tried = {}});
}

void Room::applyNewest(Values values) {
  bool is_taken = false;
  for (int k = 0; !values.untried.empty() && !is_taken; ++k) {
    if (k == kTriedMaxCount) return putOff(std::move(values));
    Command command = std::move(values.untried.back());
    values.untried.pop_back();
    Outcome outcome = refuseChange(command);
    if (!outcome) {
      if (beginChange(command, values)) return;
      outcome = applyToWater(command);
      if (!outcome) parameterChanged(command.message.set_parameter());
    }
    is_taken = !outcome;
    values.tried.push_back({std::move(command), std::move(outcome)});
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
  answers_.insert(answers_.end(), std::make_move_iterator(values.tried.rbegin()),
                  std::make_move_iterator(values.tried.rend()));
}

bool Room::beginChange(const Command& command, Values& others) {
  auto relayout = water_->relayout(command.message.set_parameter());
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
  Outcome outcome = water_->adopt(std::move(change.relayout), change.prepared.get());
  heavy_budget_.spend(std::chrono::steady_clock::now() - change.begin);
  const bool is_taken = !outcome;
  if (is_taken) {
    diary_.carriedOutLate(tick(), change.command.message);
    parameterChanged(change.command.message.set_parameter());
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

Room::Outcome Room::refuseChange(const Command& command) const {
  if (auto rejected = checkAgain(command)) return rejected;
  const v1::SetParameter& change = command.message.set_parameter();
  const auto wanted = water_->workWith(change);
  if (!wanted) return {};
  return refuseSlow(command.sender, change.path(), tick_cost_.predict_ms(*wanted), kTickMax_ms);
}

void Room::parameterChanged(const v1::SetParameter& change) {
  tick_cost_.workChanged(water_->work());
  frames_.restart();  // the frame rate may have changed; by the old rate the next frame could be up to a second away
  news_.parameters[change.path()] = change.value();
}

}  // namespace spindrift::rooms
