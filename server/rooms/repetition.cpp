#include <algorithm>
#include <utility>
#include <variant>

#include <spindrift/rooms/repetition.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/wire/client_message.h>

namespace spindrift::rooms {

using namespace std::chrono_literals;

core::Result<Repetition> Repetition::begin(KeptRoom kept, Parts parts) {
  Repetition out(std::move(kept), parts);
  const v1::KeptState& state = *out.kept_.state;
  if (auto done = parts.water.restore(state); !done) return done.error();
  parts.time.restore(parts.water.sim().derived().tick_s, state.speed(), state.paused());
  parts.chosen_fidelity = state.chosen_fidelity();
  out.steps_until_ = parts.water.tick() + state.pending_tick_count();
  return out;
}

core::Result<bool> Repetition::continueUntil(TimePoint deadline) {
  while (next_ < kept_.records.size()) {
    const auto done = repeatNext(deadline == TimePoint::max());
    if (!done || !*done) return done;
    if (std::chrono::steady_clock::now() >= deadline && next_ < kept_.records.size()) return false;
  }
  const std::uint64_t tick = parts_.water.tick();
  const bool has_steps = parts_.time.isPaused() && steps_until_ > tick;
  parts_.time.setSteps(has_steps ? static_cast<std::uint32_t>(steps_until_ - tick) : 0);
  return true;
}

core::Result<bool> Repetition::repeatNext(bool waits) {
  RoomWater& water = parts_.water;
  const v1::StateRecord& record = kept_.records[next_];
  const bool changes_water =
      record.has_scene() || record.has_continued_scene();  // written after it, which takes a tick
  if (water.tick() + (changes_water ? 1 : 0) < record.tick()) {
    water.step();
    if (const auto& error = water.sim().deviceError()) return *error;
    return true;
  }
  if (changes_water) {
    const auto done = changeWater(record, waits);
    if (!done || !*done) return done;
  } else if (record.has_command()) {
    repeat(record.command());
  }
  ++next_;
  return true;
}

core::Result<bool> Repetition::changeWater(const v1::StateRecord& record, bool waits) {
  RoomWater& water = parts_.water;
  if (!next_water_.valid()) {
    v1::Scene scene = record.has_scene() ? record.scene() : record.continued_scene();
    scene::fillDefaults(scene);
    parts_.chosen_fidelity = scene.fidelity();
    next_water_ = parts_.builder.build(std::move(scene));
  }
  if (!waits && next_water_.wait_for(0s) != std::future_status::ready) return false;
  auto next = next_water_.get();
  if (!next) return next.error();
  if (record.has_scene()) {
    parts_.builder.dispose(water.replaceWater(*std::move(next)));
    steps_until_ = 0;
  } else {
    if (auto done = water.continueIn(*next); !done) return done.error();
    parts_.builder.dispose(*std::move(next));
    if (steps_until_ >= water.tick()) ++steps_until_;  // the change took a tick, which Step commands do not count
  }
  water.bind();
  return true;
}

void Repetition::repeat(const v1::Command& message) {
  const auto checked = wire::checkCommand(message);
  const auto* command = std::get_if<v1::Command>(&checked);
  if (!command) return;
  switch (command->action_case()) {
    case v1::Command::kSetPaused:
      parts_.time.setPaused(command->set_paused().paused(), std::chrono::steady_clock::now());
      steps_until_ = 0;
      return;
    case v1::Command::kSetSpeed:
      parts_.time.setSpeed(command->set_speed().speed());
      return;
    case v1::Command::kStep:
      steps_until_ = std::max(steps_until_, parts_.water.tick()) + command->step().tick_count();
      return;
    case v1::Command::kReset:
      steps_until_ = 0;
      break;
    case v1::Command::kChangeScene:  // to the level that the room had: only the choice counts
      parts_.chosen_fidelity = command->change_scene().fidelity();
      return;
    default:
      break;
  }
  // What the water refused then, it refuses again.
  if (RoomWater::takes(*command)) (void)parts_.water.apply(*command);
}

}  // namespace spindrift::rooms
