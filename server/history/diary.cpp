#include <utility>

#include <spdlog/spdlog.h>

#include <spindrift/core/version.h>
#include <spindrift/history/diary.h>
#include <spindrift/water/water_state.h>

namespace spindrift::history {
namespace {

using namespace std::chrono_literals;

/// A room that comes back lost at most so much simulated time after the last command.
constexpr auto kProgressInterval = 500ms;

wire::CommandRejection notKept(const std::string& why) {
  return wire::rejection(v1::REJECT_REASON_BUSY, "",
                         "the server cannot keep this on disk and does not carry it out: " + why);
}

}  // namespace

core::Result<Diary> Diary::create(const std::string& room, const water::RoomWater& water,
                                  const std::filesystem::path& record_folder, std::uint32_t hash_interval_ticks,
                                  bool is_continued) {
  if (record_folder.empty()) return Diary(nullptr);
  if (is_continued) {
    spdlog::warn(
        "room {}: is not recorded, because it continues from its state on disk, and a log has to begin with a scene",
        room);
    return Diary(nullptr);
  }
  v1::RecordHeader header;
  header.set_server(std::string(core::nameAndVersion()));
  describeDevice(header, water.device());
  header.set_room(room);
  *header.mutable_scene() = water.scene();
  header.set_hash_interval_ticks(hash_interval_ticks);
  header.set_state_hash_version(water::kStateHashVersion);
  auto log = CommandLogWriter::create(record_folder, header);
  if (!log) return log.error();
  spdlog::info("room {}: recorded to {}", room, (*log)->file().string());
  return Diary(*std::move(log));
}

void Diary::log(std::uint64_t tick, v1::Record record) {
  if (!log_) return;
  record.set_tick(tick);
  log_->write(std::move(record));
}

void Diary::keep(std::uint64_t tick, v1::Record record) {
  if (!keeper_) return;
  record.set_tick(tick);
  keeper_->appendWhatHappened(record);
}

void Diary::write(std::uint64_t tick, v1::Record record) {
  log(tick, record);
  keep(tick, std::move(record));
}

std::optional<wire::CommandRejection> Diary::writeAhead(std::uint64_t tick, const v1::Command& command) {
  v1::Record record;
  record.set_tick(tick);
  *record.mutable_command() = command;
  if (keeper_) {
    if (const auto gap = keeper_->gap()) return notKept(*gap);
    if (auto appended = keeper_->append(record); !appended) return notKept(appended.error().message);
  }
  log(tick, std::move(record));
  return {};
}

void Diary::carriedOutLate(std::uint64_t tick, const v1::Command& command) {
  v1::Record record;
  *record.mutable_command() = command;
  write(tick, std::move(record));
}

void Diary::beganScene(std::uint64_t tick, const v1::Scene& scene) {
  v1::Record record;
  *record.mutable_scene() = scene;
  write(tick, std::move(record));
}

void Diary::continuedIn(std::uint64_t tick, const v1::Scene& built) {
  v1::Record record;
  *record.mutable_continued_scene() = built;
  write(tick, std::move(record));
}

void Diary::recovered(std::uint64_t tick) {
  v1::Record record;
  record.set_recovered(true);
  write(tick, std::move(record));
}

void Diary::ticked(std::uint64_t tick, sim::WaterSim& water) {
  if (std::exchange(recovered_count_, water.recoveredCount()) != water.recoveredCount()) {
    recovered(tick);
    if (keeper_) keeper_->ask();
  }
  if (!log_ || log_->ended() || tick % log_->hashInterval_ticks() != 0) return;
  v1::Record hash;
  hash.set_state_hash(water.stateHash());
  log(tick, std::move(hash));
}

void Diary::people(std::uint64_t tick, std::uint64_t version, const std::function<v1::RoomPeople()>& people) {
  if (!keeper_ || version == std::exchange(kept_people_version_, version)) return;
  v1::Record record;
  *record.mutable_people() = people();
  keep(tick, std::move(record));
}

void Diary::waterReplaced(std::uint64_t recovered_count) {
  setRecovered(recovered_count);
  if (keeper_) keeper_->ask();
}

core::Result<void> Diary::flush() {
  if (!keeper_) return {};
  return keeper_->flush();
}

bool Diary::wantsSnapshot(TimePoint now, std::uint64_t state_id) const {
  return keeper_ && keeper_->isDue(now, state_id != saved_state_id_);
}

void Diary::save(v1::KeptState state, std::uint64_t state_id, TimePoint now, double copy_s) {
  saved_state_id_ = state_id;
  next_progress_ = now + kProgressInterval;
  keeper_->save(std::move(state), now, copy_s);
}

void Diary::progress(TimePoint now, std::uint64_t tick, std::uint64_t state_id) {
  if (!keeper_ || now < next_progress_) return;
  next_progress_ = now + kProgressInterval;
  progressNow(tick, state_id);
}

void Diary::progressNow(std::uint64_t tick, std::uint64_t state_id) {
  if (std::exchange(kept_state_id_, state_id) == state_id) return;
  v1::Record record;
  record.set_running(true);
  keep(tick, std::move(record));
}

}  // namespace spindrift::history
