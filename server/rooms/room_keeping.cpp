// The state of a room on disk: what it writes while it runs, and how it continues from there after a restart.
#include <algorithm>
#include <chrono>
#include <utility>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <spindrift/core/version.h>
#include <spindrift/rooms/room.h>

namespace spindrift::rooms {
namespace {

using namespace std::chrono_literals;

std::int64_t nowUnix_ms() {
  return std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::system_clock::now().time_since_epoch())
      .count();
}

}  // namespace

// While it runs

void Room::flushKept() {
  // A refusal promises nothing, and does not wait for the disk.
  if (std::ranges::all_of(answers_, [](const Answer& one) { return one.rejected.has_value(); })) return;
  const auto flushed = diary_.flush();
  if (flushed) return;
  for (Answer& answer : answers_) {
    if (answer.rejected) continue;
    answer.rejected =
        rejection(v1::REJECT_REASON_BUSY, "",
                  "it was carried out, but the server cannot keep it on disk: " + flushed.error().message);
  }
}

void Room::keepState(TimePoint now) {
  if (is_lost_ || change_) return;
  if (diary_.wantsSnapshot(now, water_->stateId()))
    (void)save();
  else
    diary_.progress(now, tick(), water_->stateId());
}

core::Result<void> Room::save() {
  const auto begin = std::chrono::steady_clock::now();
  auto state = stateNow();
  if (!state) return core::Error{core::ErrorCode::kUnavailable, "the device does not answer"};
  const double copy_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  diary_.save(*std::move(state), water_->stateId(), begin, copy_s);
  return {};
}

core::Result<void> Room::saveUntil(TimePoint deadline) {
  StateKeeper* const keeper = diary_.keeper();
  if (!keeper || is_lost_) return {};
  water_->bind();
  const core::Error late{core::ErrorCode::kUnavailable, "the disk took too long"};
  // One that is being written is older. Without time for another the log says how far the room has come.
  if (!keeper->outcome(deadline) || std::chrono::steady_clock::now() >= deadline) {
    diary_.progressNow(tick(), water_->stateId());
    return late;
  }
  if (auto begun = save(); !begun) return begun;
  const auto saved = keeper->outcome(deadline);
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
  if (water_->failure()) return std::nullopt;  // a lost device reads as zeros
  out.set_paused(time_.isPaused());
  out.set_speed(time_.speed());
  out.set_pending_tick_count(time_.stepsToCome());
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
    restorePeople(repetition->kept());
  }
  diary_.keepIn(std::move(restoration_->keeper));
  if (!restoration_->repetition) diary_.keeper()->openGap("its first snapshot is not on the disk yet");
  restoration_.reset();
  first_snapshot_until_ = std::chrono::steady_clock::now() + rules_.disk_patience;
  if (auto begun = save(); !begun) return cannotBeWritten(begun.error());
  return true;
}

core::Result<bool> Room::isOnDisk(TimePoint deadline) {
  StateKeeper* const keeper = diary_.keeper();
  if (!keeper) return true;
  const auto outcome = keeper->outcome(std::min(deadline, first_snapshot_until_));
  if (outcome && !*outcome) return cannotBeWritten(outcome->error());
  if (outcome) return true;
  if (std::chrono::steady_clock::now() < first_snapshot_until_) return false;
  spdlog::warn("room {}: its first snapshot is not on the disk after {}: the disk is slow; the room opens without it{}",
               name_, rules_.disk_patience,
               keeper->gap() ? " and refuses commands until it is there" : ", on what was there before");
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

core::Result<Repetition> Room::beginRepetition(KeptRoom kept) {
  return Repetition::begin(std::move(kept), {*water_, time_, chosen_fidelity_, builder_});
}

core::Result<bool> Room::repeatUntil(Repetition& repetition, TimePoint deadline) {
  const auto done = repetition.continueUntil(deadline);
  if (!done || !*done) return done;
  tick_cost_.restart(water_->warmTick_ms(), water_->work());
  recovery_news_.restart(water_->sim().recoveredCount());
  diary_.setRecovered(water_->sim().recoveredCount());
  return true;
}

bool Room::restoreAfterLoss(std::unique_ptr<Water>& water) {
  auto kept = diary_.keeper() ? diary_.keeper()->newest() : std::nullopt;
  if (!kept) return false;
  const std::uint64_t lost_tick = tick();
  builder_.dispose(water_->replaceWater(std::move(water)));
  auto repetition = beginRepetition(*std::move(kept));
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
  diary_.recovered(tick());
  restartScene(true);
  boatsChanged();
  // Ticks have passed since the snapshot, and the log does not say so.
  diary_.keeper()->openGap("the room continued after its device failed, and no snapshot says so yet");
  return true;
}

}  // namespace spindrift::rooms
