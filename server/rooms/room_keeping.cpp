#include <algorithm>
#include <chrono>
#include <utility>

#include <fmt/chrono.h>
#include <spdlog/spdlog.h>

#include <spindrift/core/version.h>
#include <spindrift/rooms/room_keeping.h>

namespace spindrift::rooms {
namespace {

using Clock = std::chrono::steady_clock;

std::int64_t nowUnix_ms() {
  return std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::system_clock::now().time_since_epoch())
      .count();
}

}  // namespace

// While the room runs

void RoomKeeping::keep(TimePoint now) {
  if (parts_.diary.wantsSnapshot(now, parts_.water.stateId()))
    (void)save();
  else
    parts_.diary.progress(now, parts_.water.tick(), parts_.water.stateId());
}

core::Result<void> RoomKeeping::save() {
  const auto begin = Clock::now();
  auto state = stateNow();
  if (!state) return core::Error{core::ErrorCode::kUnavailable, "the device does not answer"};
  const double copy_s = std::chrono::duration<double>(Clock::now() - begin).count();
  parts_.diary.save(*std::move(state), parts_.water.stateId(), begin, copy_s);
  return {};
}

core::Result<void> RoomKeeping::saveUntil(TimePoint deadline) {
  history::StateKeeper* const keeper = parts_.diary.keeper();
  if (!keeper) return {};
  const core::Error late{core::ErrorCode::kUnavailable, "the disk took too long"};
  // One that is being written is older. Without time for another the log says how far the room has come.
  if (!keeper->outcome(deadline) || Clock::now() >= deadline) {
    parts_.diary.progressNow(parts_.water.tick(), parts_.water.stateId());
    return late;
  }
  if (auto begun = save(); !begun) return begun;
  const auto saved = keeper->outcome(deadline);
  return saved ? *saved : late;
}

std::optional<v1::KeptState> RoomKeeping::stateNow() {
  v1::KeptState out;
  out.set_server(std::string(core::nameAndVersion()));
  out.set_device(parts_.water.device().name);
  out.set_gl_version(parts_.water.device().gl_version);
  out.set_room(parts_.room);
  out.set_saved_at_ms(nowUnix_ms());
  parts_.water.save(out);
  if (parts_.water.failure()) return std::nullopt;  // a lost device reads as zeros
  out.set_paused(parts_.time.isPaused());
  out.set_speed(parts_.time.speed());
  out.set_pending_tick_count(parts_.time.stepsToCome());
  out.set_chosen_fidelity(parts_.chosen_fidelity);
  *out.mutable_people() = parts_.roster.kept();
  *out.mutable_access() = parts_.access;
  return out;
}

// After a restart

core::Result<void> RoomKeeping::begin(history::RoomPlace place) {
  if (!place.keeper) return {};
  restoration_.emplace(Restoration{.keeper = std::move(place.keeper), .room = std::nullopt});
  if (!place.kept) return {};
  auto room = history::RestoredRoom::begin(*std::move(place.kept), {parts_.water, parts_.builder});
  if (!room) return room.error();
  restoration_->room.emplace(*std::move(room));
  return {};
}

core::Result<bool> RoomKeeping::restoreUntil(TimePoint deadline) {
  if (!restoration_) return true;
  parts_.water.bind();
  if (auto& room = restoration_->room) {
    const auto done = room->continueUntil(deadline);
    if (!done || !*done) return done;
    parts_.diary.setRecovered(parts_.water.sim().recoveredCount());
    const history::RepeatedRoom rest = room->room();
    parts_.time.restore(parts_.water.sim().derived().tick_s, rest.speed, rest.is_paused, rest.pending_tick_count);
    parts_.chosen_fidelity = rest.chosen_fidelity;
    restorePeople(room->kept());
  }
  parts_.diary.keepIn(std::move(restoration_->keeper));
  if (!restoration_->room) parts_.diary.keeper()->openGap("its first snapshot is not on the disk yet");
  restoration_.reset();
  first_snapshot_until_ = Clock::now() + parts_.disk_patience;
  if (auto begun = save(); !begun) return cannotBeWritten(begun.error());
  return true;
}

core::Result<bool> RoomKeeping::isOnDisk(TimePoint deadline) {
  history::StateKeeper* const keeper = parts_.diary.keeper();
  if (!keeper) return true;
  const auto outcome = keeper->outcome(std::min(deadline, first_snapshot_until_));
  if (outcome && !*outcome) return cannotBeWritten(outcome->error());
  if (outcome) return true;
  if (Clock::now() < first_snapshot_until_) return false;
  spdlog::warn("room {}: its first snapshot is not on the disk after {}: the disk is slow; the room opens without it{}",
               parts_.room, parts_.disk_patience,
               keeper->gap() ? " and refuses commands until it is there" : ", on what was there before");
  return true;
}

core::Error RoomKeeping::cannotBeWritten(const core::Error& why) const {
  // Not a fault of what was kept, whatever the reason.
  return {core::ErrorCode::kUnavailable, "room " + parts_.room + ": its state cannot be written: " + why.message};
}

void RoomKeeping::restorePeople(const history::KeptRoom& kept) {
  const v1::KeptState& state = *kept.state;
  v1::RoomPeople people = state.people();
  for (const v1::Record& record : kept.records) {
    if (record.has_people()) people = record.people();
  }
  parts_.roster.restore(people, Clock::now());
  parts_.roster.keepOnly(parts_.water.boatIds());
  parts_.access = state.access();
  const auto when = std::chrono::system_clock::time_point(std::chrono::milliseconds(state.saved_at_ms()));
  const std::uint64_t tick = parts_.water.tick();
  spdlog::info("room {}: continues at tick {} of scene {}, {} ticks and {} records after its snapshot of {:%F %T} UTC",
               parts_.room, tick, parts_.water.scene().name(), tick - state.tick(), kept.records.size(),
               fmt::gmtime(std::chrono::system_clock::to_time_t(when)));
}

}  // namespace spindrift::rooms
