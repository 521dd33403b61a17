#include <algorithm>
#include <chrono>
#include <utility>

#include <fmt/chrono.h>
#include <spdlog/spdlog.h>

#include <spindrift/core/version.h>
#include <spindrift/rooms/room_keeping.h>

namespace spindrift::rooms {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

/// A room that comes back lost at most so much simulated time after the last command.
constexpr auto kProgressInterval = 500ms;

std::int64_t nowUnix_ms() {
  return std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::system_clock::now().time_since_epoch())
      .count();
}

}  // namespace

// While the room runs

void RoomKeeping::keep(TimePoint now) {
  const history::StateKeeper* const keeper = room_.diary.keeper();
  if (!keeper) return;
  if (keeper->isDue(now, room_.water->stateId() != saved_state_id_)) {
    (void)save();
  } else if (now >= next_progress_) {
    next_progress_ = now + kProgressInterval;
    writeProgress();
  }
}

core::Result<void> RoomKeeping::save() {
  const auto begin = Clock::now();
  auto state = stateNow();
  if (!state) return core::unavailable("the device does not answer");
  const double copy_s = std::chrono::duration<double>(Clock::now() - begin).count();
  saved_state_id_ = room_.water->stateId();
  next_progress_ = begin + kProgressInterval;
  room_.diary.keeper()->save(*std::move(state), begin, copy_s);
  return {};
}

void RoomKeeping::writeProgress() {
  if (std::exchange(told_state_id_, room_.water->stateId()) == room_.water->stateId()) return;
  v1::Record record;
  record.set_tick(room_.water->tick());
  record.set_running(true);
  room_.diary.keeper()->appendWhatHappened(record);
}

core::Result<void> RoomKeeping::saveUntil(TimePoint deadline) {
  history::StateKeeper* const keeper = room_.diary.keeper();
  if (!keeper) return {};
  const core::Error late = core::unavailable("the disk took too long");
  // One that is being written is older. Without time for another the log says how far the room has come.
  if (!keeper->outcome(deadline) || Clock::now() >= deadline) {
    writeProgress();
    return late;
  }
  if (auto begun = save(); !begun) return begun;
  const auto saved = keeper->outcome(deadline);
  return saved ? *saved : late;
}

std::optional<v1::KeptState> RoomKeeping::stateNow() {
  v1::KeptState out;
  out.set_server(std::string(core::nameAndVersion()));
  out.set_device(room_.water->device().name);
  out.set_gl_version(room_.water->device().gl_version);
  out.set_room(room_.name);
  out.set_saved_at_ms(nowUnix_ms());
  room_.water->save(out);
  if (room_.water->failure()) return std::nullopt;  // a lost device reads as zeros
  out.set_paused(room_.time.isPaused());
  out.set_speed(room_.time.speed());
  out.set_pending_tick_count(room_.time.stepsToCome());
  out.set_chosen_fidelity(room_.chosen_fidelity);
  *out.mutable_people() = room_.roster.kept();
  *out.mutable_access() = room_.access;
  return out;
}

// After a restart

core::Result<void> RoomKeeping::begin(history::RoomPlace place) {
  coming_keeper_ = std::move(place.keeper);
  if (!coming_keeper_ || !place.kept) return {};
  auto restored = history::RestoredRoom::begin(*std::move(place.kept), *room_.water, room_.builder);
  if (!restored) return restored.error();
  restored_.emplace(*std::move(restored));
  return {};
}

core::Result<bool> RoomKeeping::restoreUntil(TimePoint deadline) {
  if (!coming_keeper_) return true;
  room_.water->bind();
  if (restored_) {
    const auto done = restored_->continueUntil(deadline);
    if (!done || !*done) return done;
    room_.diary.waterReplaced();
    const history::RepeatedRoom rest = restored_->room();
    room_.time.restore(room_.water->sim().derived().tick_s, rest.speed, rest.is_paused, rest.pending_tick_count);
    room_.chosen_fidelity = rest.chosen_fidelity;
    restorePeople(restored_->kept());
  }
  room_.diary.keepIn(std::move(coming_keeper_));
  if (!restored_) room_.diary.keeper()->openGap("its first snapshot is not on the disk yet");
  restored_.reset();
  first_snapshot_until_ = Clock::now() + room_.rules.disk_patience;
  if (auto begun = save(); !begun) return cannotBeWritten(begun.error());
  return true;
}

core::Result<bool> RoomKeeping::isOnDisk(TimePoint deadline) {
  history::StateKeeper* const keeper = room_.diary.keeper();
  if (!keeper) return true;
  const auto outcome = keeper->outcome(std::min(deadline, first_snapshot_until_));
  if (outcome && !*outcome) return cannotBeWritten(outcome->error());
  if (outcome) return true;
  if (Clock::now() < first_snapshot_until_) return false;
  spdlog::warn("room {}: its first snapshot is not on the disk after {}: the disk is slow; the room opens without it{}",
               room_.name, room_.rules.disk_patience,
               keeper->gap() ? " and refuses commands until it is there" : ", on what was there before");
  return true;
}

core::Error RoomKeeping::cannotBeWritten(const core::Error& why) const {
  // Not a fault of what was kept, whatever the reason.
  return {core::ErrorCode::kUnavailable, "room " + room_.name + ": its state cannot be written: " + why.message};
}

void RoomKeeping::restorePeople(const history::KeptRoom& kept) {
  const v1::KeptState& state = *kept.state;
  v1::RoomPeople people = state.people();
  for (const v1::Record& record : kept.records) {
    if (record.has_people()) people = record.people();
  }
  room_.roster.restore(people, Clock::now());
  room_.roster.keepOnly(room_.water->boatIds());
  room_.access = state.access();
  const auto when = std::chrono::system_clock::time_point(std::chrono::milliseconds(state.saved_at_ms()));
  const std::uint64_t tick = room_.water->tick();
  spdlog::info("room {}: continues at tick {} of scene {}, {} ticks and {} records after its snapshot of {:%F %T} UTC",
               room_.name, tick, room_.water->scene().name(), tick - state.tick(), kept.records.size(),
               fmt::gmtime(std::chrono::system_clock::to_time_t(when)));
}

}  // namespace spindrift::rooms
