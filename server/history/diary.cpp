#include <utility>

#include <spdlog/spdlog.h>

#include <spindrift/core/version.h>
#include <spindrift/history/diary.h>
#include <spindrift/water/water_state.h>

namespace spindrift::history {
namespace {

wire::CommandRejection notKept(const std::string& why) {
  return wire::rejection(v1::REJECT_REASON_BUSY, "",
                         "the server cannot keep this on disk and does not carry it out: " + why);
}

}  // namespace

core::Result<Diary> Diary::create(const std::string& room, water::RoomWater& water,
                                  const std::filesystem::path& record_folder, std::uint32_t hash_interval_ticks,
                                  bool is_continued) {
  if (record_folder.empty()) return Diary(water, nullptr);
  if (is_continued) {
    spdlog::warn(
        "room {}: is not recorded, because it continues from its state on disk, and a log has to begin with a scene",
        room);
    return Diary(water, nullptr);
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
  return Diary(water, *std::move(log));
}

v1::Record Diary::recordNow() const {
  v1::Record out;
  out.set_tick(water_.tick());
  return out;
}

void Diary::write(const v1::Record& record) {
  if (log_) log_->write(record);
  if (keeper_) keeper_->appendWhatHappened(record);
}

std::optional<wire::CommandRejection> Diary::writeAhead(const v1::Command& command) {
  v1::Record record = recordNow();
  *record.mutable_command() = command;
  if (keeper_) {
    if (const auto gap = keeper_->gap()) return notKept(*gap);
    if (auto appended = keeper_->append(record); !appended) return notKept(appended.error().message);
  }
  if (log_) log_->write(std::move(record));
  return {};
}

void Diary::carriedOutLate(const v1::Command& command) {
  v1::Record record = recordNow();
  *record.mutable_command() = command;
  write(record);
}

void Diary::beganScene() {
  v1::Record record = recordNow();
  *record.mutable_scene() = water_.scene();
  write(record);
}

void Diary::continuedIn(const v1::Scene& built) {
  v1::Record record = recordNow();
  *record.mutable_continued_scene() = built;
  write(record);
}

void Diary::recovered() {
  v1::Record record = recordNow();
  record.set_recovered(true);
  write(record);
}

void Diary::ticked() {
  sim::WaterSim& sim = water_.sim();
  if (std::exchange(recovered_count_, sim.recoveredCount()) != sim.recoveredCount()) {
    recovered();
    if (keeper_) keeper_->ask();
  }
  if (!log_ || log_->ended() || water_.tick() % log_->hashInterval_ticks() != 0) return;
  v1::Record hash = recordNow();
  hash.set_state_hash(sim.stateHash());
  log_->write(std::move(hash));
}

void Diary::people(std::uint64_t version, const std::function<v1::RoomPeople()>& people) {
  if (!keeper_ || version == std::exchange(kept_people_version_, version)) return;
  v1::Record record = recordNow();
  *record.mutable_people() = people();
  keeper_->appendWhatHappened(record);
}

void Diary::waterReplaced() {
  recovered_count_ = water_.sim().recoveredCount();
  if (keeper_) keeper_->ask();
}

core::Result<void> Diary::flush() {
  if (!keeper_) return {};
  return keeper_->flush();
}

}  // namespace spindrift::history
