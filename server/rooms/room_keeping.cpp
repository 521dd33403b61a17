// The state of a room on disk: what it writes while it runs, and how it continues from there after a restart.
#include <algorithm>
#include <chrono>
#include <utility>
#include <variant>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <spindrift/core/version.h>
#include <spindrift/rooms/room.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/wire/client_message.h>

namespace spindrift::rooms {
namespace {

using namespace std::chrono_literals;

/// A room that comes back lost at most so much simulated time after the last command.
constexpr auto kRunningInterval = 500ms;

wire::CommandRejection notKept(const std::string& why) {
  return rejection(v1::REJECT_REASON_BUSY, "", "the server cannot keep this on disk and does not carry it out: " + why);
}

std::int64_t nowUnix_ms() {
  return std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::system_clock::now().time_since_epoch())
      .count();
}

}  // namespace

// While it runs

Room::Outcome Room::keep(const Command& command) {
  if (!keeper_) return {};
  if (const auto gap = keeper_->gap()) return notKept(*gap);
  v1::StateRecord record;
  record.set_tick(tick());
  *record.mutable_command() = command.message;
  if (auto appended = keeper_->append(record); !appended) return notKept(appended.error().message);
  return {};
}

void Room::keepWhatHappened(v1::StateRecord record) {
  if (!keeper_) return;
  record.set_tick(tick());
  keeper_->appendWhatHappened(record);
}

void Room::keepPeople() {
  if (!keeper_) return;
  const std::uint64_t version = roster_.version();
  if (version == std::exchange(kept_people_version_, version)) return;
  v1::StateRecord record;
  *record.mutable_people() = roster_.kept();
  keepWhatHappened(std::move(record));
}

void Room::flushKept() {
  // A refusal promises nothing, and does not wait for the disk.
  if (!keeper_ || std::ranges::all_of(answers_, [](const Answer& one) { return one.rejected.has_value(); })) return;
  const auto flushed = keeper_->flush();
  if (flushed) return;
  for (Answer& answer : answers_) {
    if (answer.rejected) continue;
    answer.rejected =
        rejection(v1::REJECT_REASON_BUSY, "",
                  "it was carried out, but the server cannot keep it on disk: " + flushed.error().message);
  }
}

void Room::keepState(TimePoint now) {
  if (!keeper_ || is_lost_ || change_) return;
  // What the watchdog restored does not follow from the log.
  const std::uint64_t recovered_count = water_->sim().recoveredCount();
  if (recovered_count != std::exchange(kept_recovery_count_, recovered_count)) keeper_->ask();
  if (keeper_->isDue(now, water_->stateId() != saved_state_id_)) {
    (void)save();
    next_running_ = now + kRunningInterval;
  } else if (now >= next_running_) {
    keepTick();
    next_running_ = now + kRunningInterval;
  }
}

void Room::keepTick() {
  if (std::exchange(kept_state_id_, water_->stateId()) == water_->stateId()) return;
  v1::StateRecord record;
  record.set_running(true);
  keepWhatHappened(std::move(record));
}

core::Result<void> Room::save() {
  const auto begin = std::chrono::steady_clock::now();
  auto state = stateNow();
  if (!state) return core::Error{core::ErrorCode::kUnavailable, "the device does not answer"};
  const double copy_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  keeper_->save(*std::move(state), begin, copy_s);
  return {};
}

core::Result<void> Room::saveUntil(TimePoint deadline) {
  if (!keeper_ || is_lost_) return {};
  water_->bind();
  const core::Error late{core::ErrorCode::kUnavailable, "the disk took too long"};
  // One that is being written is older. Without time for another the log says how far the room has come.
  if (!keeper_->outcome(deadline) || std::chrono::steady_clock::now() >= deadline) {
    keepTick();
    return late;
  }
  if (auto begun = save(); !begun) return begun;
  const auto saved = keeper_->outcome(deadline);
  return saved ? *saved : late;
}

std::optional<v1::KeptState> Room::stateNow() {
  v1::KeptState out;
  out.set_server(std::string(core::nameAndVersion()));
  out.set_device(water_->device().name);
  out.set_gl_version(water_->device().gl_version);
  out.set_room(name_);
  out.set_saved_at_ms(nowUnix_ms());
  water_->save(out);
  saved_state_id_ = water_->stateId();
  if (water_->failure()) return std::nullopt;  // a lost device reads as zeros
  out.set_paused(paused_);
  out.set_speed(clock_.speed());
  out.set_pending_tick_count(pending_tick_count_);
  out.set_chosen_fidelity(chosen_fidelity_);
  *out.mutable_people() = roster_.kept();
  *out.mutable_access() = access_;
  return out;
}

// After a restart

core::Result<bool> Room::restoreUntil(TimePoint deadline) {
  if (!restoration_) return true;
  water_->bind();
  if (auto& repetition = restoration_->repetition) {
    const auto done = repeatUntil(*repetition, deadline);
    if (!done || !*done) return done;
    restorePeople(repetition->kept);
  }
  keeper_ = std::move(restoration_->keeper);
  if (!restoration_->repetition) keeper_->openGap("its first snapshot is not on the disk yet");
  restoration_.reset();
  first_snapshot_until_ = std::chrono::steady_clock::now() + rules_.disk_patience;
  if (auto begun = save(); !begun) return cannotBeWritten(begun.error());
  return true;
}

core::Result<bool> Room::isOnDisk(TimePoint deadline) {
  if (!keeper_) return true;
  const auto outcome = keeper_->outcome(std::min(deadline, first_snapshot_until_));
  if (outcome && !*outcome) return cannotBeWritten(outcome->error());
  if (outcome) return true;
  if (std::chrono::steady_clock::now() < first_snapshot_until_) return false;
  spdlog::warn("room {}: its first snapshot is not on the disk after {}: the disk is slow; the room opens without it{}",
               name_, rules_.disk_patience,
               keeper_->gap() ? " and refuses commands until it is there" : ", on what was there before");
  return true;
}

core::Error Room::cannotBeWritten(const core::Error& why) const {
  // Not a fault of what was kept, whatever the reason.
  return {core::ErrorCode::kUnavailable, "room " + name_ + ": its state cannot be written: " + why.message};
}

void Room::restorePeople(const KeptRoom& kept) {
  const v1::KeptState& state = *kept.state;
  v1::RoomPeople people = state.people();
  for (const v1::StateRecord& record : kept.records) {
    if (record.has_people()) people = record.people();
  }
  roster_.restore(people, std::chrono::steady_clock::now());
  access_ = state.access();
  boatsChanged();
  boats_ = water_->boats();
  publishSnapshot();
  publishVitals({});
  const auto when = std::chrono::system_clock::time_point(std::chrono::milliseconds(state.saved_at_ms()));
  spdlog::info("room {}: continues at tick {} of scene {}, {} ticks and {} records after its snapshot of {:%F %T} UTC",
               name_, tick(), water_->scene().name(), tick() - state.tick(), kept.records.size(),
               fmt::gmtime(std::chrono::system_clock::to_time_t(when)));
}

core::Result<Room::Repetition> Room::repetitionOf(KeptRoom kept) {
  const v1::KeptState& state = *kept.state;
  if (auto done = water_->restore(state); !done) return done.error();
  clock_ = RealTimeClock(water_->sim().derived().tick_s);
  if (state.speed() > 0) clock_.setSpeed(state.speed());
  paused_ = state.paused();
  chosen_fidelity_ = state.chosen_fidelity();
  const std::uint64_t steps_until = tick() + state.pending_tick_count();
  return Repetition{.kept = std::move(kept), .next = 0, .steps_until = steps_until};
}

core::Result<bool> Room::repeatUntil(Repetition& all, TimePoint deadline) {
  while (all.next < all.kept.records.size()) {
    const auto done = repeatSome(all, deadline == TimePoint::max());
    if (!done || !*done) return done;
    if (std::chrono::steady_clock::now() >= deadline && all.next < all.kept.records.size()) return false;
  }
  pending_tick_count_ = paused_ && all.steps_until > tick() ? static_cast<std::uint32_t>(all.steps_until - tick()) : 0;
  tick_cost_.restart(water_->warmTick_ms(), water_->work());
  recovery_news_.restart(water_->sim().recoveredCount());
  kept_recovery_count_ = water_->sim().recoveredCount();
  return true;
}

bool Room::restoreAfterLoss(std::unique_ptr<Water>& water) {
  auto kept = keeper_ ? keeper_->newest() : std::nullopt;
  if (!kept) return false;
  const std::uint64_t lost_tick = tick();
  builder_.dispose(water_->replaceWater(std::move(water)));
  auto repetition = repetitionOf(*std::move(kept));
  const auto done = repetition ? repeatUntil(*repetition, TimePoint::max()) : core::Result<bool>(repetition.error());
  if (!done) {
    spdlog::error("room {}: its state cannot be restored: {}", name_, done.error().message);
    water_->sim().reset();
    is_lost_ = false;
    restartScene(false);
    return true;
  }
  water_->goOnAfter(lost_tick);
  is_lost_ = false;
  v1::Record line;
  line.set_recovered(true);  // a replay does not repeat it
  record(std::move(line));
  restartScene(true);
  boatsChanged();
  // Ticks have passed since the snapshot, and the log does not say so.
  keeper_->openGap("the room continued after its device failed, and no snapshot says so yet");
  return true;
}

core::Result<bool> Room::repeatSome(Repetition& all, bool waits) {
  const v1::StateRecord& record = all.kept.records[all.next];
  const bool changes_water =
      record.has_scene() || record.has_continued_scene();  // written after it, which takes a tick
  if (tick() + (changes_water ? 1 : 0) < record.tick()) {
    water_->step();
    if (const auto& error = water_->sim().deviceError()) return *error;
    return true;
  }
  if (changes_water) {
    if (!all.water.valid()) {
      v1::Scene scene = record.has_scene() ? record.scene() : record.continued_scene();
      scene::fillDefaults(scene);
      chosen_fidelity_ = scene.fidelity();
      all.water = builder_.build(std::move(scene));
    }
    if (!waits && all.water.wait_for(0s) != std::future_status::ready) return false;
    auto next = all.water.get();
    if (!next) return next.error();
    if (record.has_scene()) {
      builder_.dispose(water_->replaceWater(*std::move(next)));
      all.steps_until = 0;
    } else {
      if (auto done = water_->continueIn(*next); !done) return done.error();
      builder_.dispose(*std::move(next));
      if (all.steps_until >= tick()) ++all.steps_until;  // the change took a tick, which is none of Step's
    }
    water_->bind();
  } else if (record.has_command()) {
    repeat(record.command(), all.steps_until);
  }
  ++all.next;
  return true;
}

void Room::repeat(const v1::Command& message, std::uint64_t& steps_until) {
  const auto checked = wire::checkCommand(message);
  const auto* command = std::get_if<v1::Command>(&checked);
  if (!command) return;
  switch (command->action_case()) {
    case v1::Command::kSetPaused:
      paused_ = command->set_paused().paused();
      steps_until = 0;
      return;
    case v1::Command::kSetSpeed:
      clock_.setSpeed(command->set_speed().speed());
      return;
    case v1::Command::kStep:
      steps_until = std::max(steps_until, tick()) + command->step().tick_count();
      return;
    case v1::Command::kReset:
      steps_until = 0;
      break;
    case v1::Command::kChangeScene:  // to the level that the room had: only the choice counts
      chosen_fidelity_ = command->change_scene().fidelity();
      return;
    default:
      break;
  }
  // What the water refused then, it refuses again.
  if (RoomWater::takes(*command)) (void)water_->apply(*command);
  return;
}

}  // namespace spindrift::rooms
