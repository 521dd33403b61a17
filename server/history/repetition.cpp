#include <algorithm>
#include <utility>
#include <variant>

#include <spindrift/history/repetition.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/wire/client_message.h>

namespace spindrift::history {

using namespace std::chrono_literals;

core::Result<void> Repetition::restore(const v1::KeptState& state) {
  if (auto done = water_.restore(state); !done) return done;
  room_ = {.speed = state.speed(), .is_paused = state.paused(), .chosen_fidelity = state.chosen_fidelity()};
  steps_until_ = water_.tick() + state.pending_tick_count();
  return {};
}

core::Result<bool> Repetition::advance(const v1::Record& record, Wait wait) {
  const bool changes_water =
      record.has_scene() || record.has_continued_scene();  // written after it, which takes a tick
  if (water_.tick() + (changes_water ? 1 : 0) < record.tick()) {
    water_.step();
    if (const auto& error = water_.sim().deviceError()) return *error;
    return false;
  }
  if (changes_water) return changeWater(record, wait);
  if (record.has_command()) repeat(record.command());
  return true;
}

RepeatedRoom Repetition::room() const {
  RepeatedRoom out = room_;
  const std::uint64_t tick = water_.tick();
  if (room_.is_paused && steps_until_ > tick) out.pending_tick_count = static_cast<std::uint32_t>(steps_until_ - tick);
  return out;
}

core::Result<bool> Repetition::changeWater(const v1::Record& record, Wait wait) {
  if (!next_water_.valid()) {
    v1::Scene scene = record.has_scene() ? record.scene() : record.continued_scene();
    scene::fillDefaults(scene);
    room_.chosen_fidelity = scene.fidelity();
    next_water_ = builder_.build(std::move(scene));
  }
  if (wait == Wait::kNo && next_water_.wait_for(0s) != std::future_status::ready) return false;
  auto next = next_water_.get();
  if (!next) return next.error();
  if (record.has_scene()) {
    builder_.dispose(water_.replaceWater(*std::move(next)));
    steps_until_ = 0;
  } else {
    if (auto done = water_.continueIn(*next); !done) return done.error();
    builder_.dispose(*std::move(next));
    if (steps_until_ >= water_.tick()) ++steps_until_;  // the change took a tick, which Step commands do not count
  }
  water_.bind();
  return true;
}

void Repetition::repeat(const v1::Command& message) {
  const auto checked = wire::checkCommand(message);
  const auto* command = std::get_if<v1::Command>(&checked);
  if (!command) return;
  switch (command->action_case()) {
    case v1::Command::kSetPaused:
      room_.is_paused = command->set_paused().paused();
      steps_until_ = 0;
      break;
    case v1::Command::kSetSpeed:
      room_.speed = command->set_speed().speed();
      break;
    case v1::Command::kStep:
      steps_until_ = std::max(steps_until_, water_.tick()) + command->step().tick_count();
      break;
    case v1::Command::kChangeScene:  // to the level that the room had: only the choice counts
      room_.chosen_fidelity = command->change_scene().fidelity();
      break;
    default:
      if (command->has_reset()) steps_until_ = 0;
      // What the water refused then, it refuses again.
      if (water::RoomWater::takes(*command) && !water_.apply(*command)) ++command_count_;
  }
}

core::Result<RestoredRoom> RestoredRoom::begin(KeptRoom kept, water::RoomWater& water, water::WaterBuilder& builder) {
  Repetition repetition(water, builder);
  if (auto done = repetition.restore(*kept.state); !done) return done.error();
  return RestoredRoom(std::move(kept), std::move(repetition));
}

core::Result<bool> RestoredRoom::continueUntil(TimePoint deadline) {
  const auto wait = deadline == TimePoint::max() ? Repetition::Wait::kForNewWater : Repetition::Wait::kNo;
  while (next_ < kept_.records.size()) {
    const auto done = repetition_.advance(kept_.records[next_], wait);
    if (!done) return done;
    if (*done) ++next_;
    if (next_ < kept_.records.size() && std::chrono::steady_clock::now() >= deadline) return false;
  }
  return true;
}

}  // namespace spindrift::history
