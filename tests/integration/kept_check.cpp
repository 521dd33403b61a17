#include "kept_check.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iterator>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <spindrift/rooms/room.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/water/water_builder.h>

#include "open_room.h"
#include "silent_outlets.h"

namespace spindrift::test {
namespace {

namespace fs = std::filesystem;

/// docs/state_files.md: the start, length and checksum of the payload; the name of the room follows, and the payload.
constexpr std::streamoff kSnapshotHeadBytes = 32 + 8 + 4;

std::vector<std::uint64_t> numbers(const fs::path& folder, const std::string& extension) {
  std::vector<std::uint64_t> out;
  std::error_code gone;
  for (const auto& entry : fs::directory_iterator(folder, gone))
    if (entry.path().extension() == extension) out.push_back(std::stoull(entry.path().stem().string()));
  std::ranges::sort(out);
  return out;
}

fs::path roomFolder(const fs::path& state_folder, const std::string& room) {
  return state_folder / "rooms" / room;
}

bool owns(const v1::RoomPeople& people, std::uint32_t person_id, std::uint32_t boat_id) {
  return std::ranges::any_of(people.people(), [&](const v1::KeptPerson& person) {
    return person.person_id() == person_id && std::ranges::count(person.boat_ids(), boat_id) > 0;
  });
}

/// Counts the words that differ and shows the first ones; empty if none do.
std::string wordDifferences(const std::string& one, const std::string& other) {
  if (one.size() != other.size()) return fmt::format("{} and {} bytes", one.size(), other.size());
  std::string first;
  std::size_t count = 0;
  for (std::size_t at = 0; at + 4 <= one.size(); at += 4) {
    if (std::equal(&one[at], &one[at] + 4, &other[at])) continue;
    float a = 0;
    float b = 0;
    std::memcpy(&a, &one[at], 4);
    std::memcpy(&b, &other[at], 4);
    if (++count <= 8) first += fmt::format(" [{}] {} and {},", at / 4, a, b);
  }
  return count == 0 ? "" : fmt::format("{} of {} words:{}", count, one.size() / 4, first);
}

/// Returns whether the record says what the command did. The id of a reset may be that of an equal one of somebody
/// else: both were carried out together.
bool says(const v1::Record& record, const SentCommand& sent) {
  if (record.tick() != sent.tick || !record.has_command()) return false;
  if (sent.command.has_reset()) return record.command().has_reset();
  return record.command().SerializeAsString() == sent.command.SerializeAsString();
}

bool isScene(const v1::Scene& scene, const v1::ChangeScene& wanted) {
  return scene.name() == wanted.name() && (!wanted.has_fidelity() || scene.fidelity() == wanted.fidelity());
}

Found findScene(const SentCommand& sent, const history::KeptRoom& kept) {
  const v1::ChangeScene& wanted = sent.command.change_scene();
  // A change to what the room has already is acknowledged and changes nothing.
  bool is_there = isScene(kept.state->scene(), wanted);
  for (const v1::Record& record : kept.records) {
    if (record.tick() > sent.tick) break;
    if (record.has_scene()) is_there = isScene(record.scene(), wanted);
    if (record.has_continued_scene()) is_there = isScene(record.continued_scene(), wanted);
  }
  return is_there ? Found::kInLog : Found::kNowhere;
}

Found findOwner(const SentCommand& sent, const history::KeptRoom& kept, const std::vector<SentCommand>& all) {
  const std::uint32_t boat_id = sent.command.take_boat().boat_id();
  bool is_owner = owns(kept.state->people(), sent.person_id, boat_id);
  for (const v1::Record& record : kept.records) {
    if (record.tick() > sent.tick) break;
    if (record.has_people()) is_owner = owns(record.people(), sent.person_id, boat_id);
  }
  if (is_owner) return Found::kInLog;
  // The record of the people says how it is at the end of a tick: another command of the same tick may have taken it.
  const bool was_taken = std::ranges::any_of(all, [&](const SentCommand& other) {
    const v1::Command& command = other.command;
    const bool takes =
        command.has_reset() || command.has_change_scene() ||
        (command.has_take_boat() && command.take_boat().boat_id() == boat_id && other.person_id != sent.person_id) ||
        (command.has_remove_boat() && command.remove_boat().boat_id() == boat_id);
    return takes && (other.state == SentCommand::State::kUnanswered ||
                     (other.state == SentCommand::State::kAcknowledged && other.tick == sent.tick));
  });
  return was_taken ? Found::kInLog : Found::kNowhere;
}

}  // namespace

std::vector<std::uint64_t> snapshotNumbers(const fs::path& state_folder, const std::string& room) {
  return numbers(roomFolder(state_folder, room), ".snapshot");
}

std::uint64_t lastGeneration(const fs::path& state_folder, const std::string& room) {
  std::uint64_t last = 0;
  for (const char* extension : {".snapshot", ".log"})
    for (const std::uint64_t number : numbers(roomFolder(state_folder, room), extension)) last = std::max(last, number);
  return last;
}

void removeNewestSnapshots(const fs::path& state_folder) {
  for (const auto& room : fs::directory_iterator(state_folder / "rooms")) {
    const auto all = numbers(room.path(), ".snapshot");
    if (all.size() > 1) fs::remove(room.path() / fmt::format("{:012}.snapshot", all.back()));
  }
}

std::optional<v1::KeptState> readSnapshot(const fs::path& state_folder, const std::string& room, std::uint64_t number) {
  std::ifstream file(roomFolder(state_folder, room) / fmt::format("{:012}.snapshot", number), std::ios::binary);
  if (!file) return std::nullopt;
  file.seekg(kSnapshotHeadBytes + static_cast<std::streamoff>(room.size()));
  const std::string payload(std::istreambuf_iterator<char>(file), {});
  v1::KeptState state;
  if (!state.ParseFromString(payload)) return std::nullopt;
  return state;
}

core::Result<std::optional<v1::KeptState>> restoredRoom(history::StateStore& store, const std::string& room,
                                                        const gpu::DeviceChoice& device, std::uint64_t least_tick) {
  auto place = store.place(room);
  if (!place) return place.error();
  if (!place->kept) return std::optional<v1::KeptState>();
  std::vector<v1::Record>& records = place->kept->records;
  if ((records.empty() ? 0 : records.back().tick()) < least_tick) {
    v1::Record& running = records.emplace_back();
    running.set_tick(least_tick);
    running.set_running(true);
  }
  water::WaterBuilder builder(device);
  const rooms::RoomRules rules;
  SilentOutlets outlets;
  v1::Scene start = place->kept->state->start_scene();
  scene::fillDefaults(start);
  auto water = builder.build(std::move(start)).get();
  if (!water) return water.error();
  (*water)->bind();
  {
    auto made = test::openRoom(room, *std::move(water), rules, builder, outlets, *std::move(place));
    if (!made) return made.error();
    (*made)->releaseDevice();
  }
  // It has written what it is now.
  auto now = store.place(room);
  if (!now) return now.error();
  if (!now->kept || !now->kept->records.empty())
    return core::Error{core::ErrorCode::kInternal, "room " + room + ": its first snapshot cannot be read back"};
  return std::optional(*now->kept->state);
}

std::vector<std::string> differences(const v1::KeptState& a, const v1::KeptState& b) {
  std::vector<std::string> out;
  const auto compare = [&](const char* what, const auto& one, const auto& other) {
    if (one != other) out.push_back(fmt::format("{}: {} and {}", what, one, other));
  };
  const auto compareBytes = [&](const std::string& what, const std::string& one, const std::string& other) {
    if (one != other) out.push_back(what + ": " + wordDifferences(one, other));
  };
  compare("tick", a.tick(), b.tick());
  compare("hash", a.state_hash(), b.state_hash());
  compare("paused", a.paused(), b.paused());
  compare("speed", a.speed(), b.speed());
  compare("ticks to come", a.pending_tick_count(), b.pending_tick_count());
  compare("chosen fidelity", static_cast<int>(a.chosen_fidelity()), static_cast<int>(b.chosen_fidelity()));
  if (a.scene().SerializeAsString() != b.scene().SerializeAsString())
    compare("scene", a.scene().ShortDebugString(), b.scene().ShortDebugString());
  compare("people", a.people().ShortDebugString(), b.people().ShortDebugString());
  const v1::WaterState& x = a.water();
  const v1::WaterState& y = b.water();
  compareBytes("layout", x.layout(), y.layout());
  compare("buffers", x.buffers_size(), y.buffers_size());
  for (int k = 0; k < std::min(x.buffers_size(), y.buffers_size()); ++k)
    compareBytes("buffer " + x.buffers(k).name(), x.buffers(k).words(), y.buffers(k).words());
  v1::WaterState rest_x = x;
  v1::WaterState rest_y = y;
  for (v1::WaterState* rest : {&rest_x, &rest_y}) {
    rest->clear_layout();
    rest->clear_buffers();
  }
  if (rest_x.SerializeAsString() != rest_y.SerializeAsString())
    compare("rest of the water", rest_x.ShortDebugString(), rest_y.ShortDebugString());
  return out;
}

Found find(const SentCommand& sent, const history::KeptRoom& kept, const std::vector<SentCommand>& all) {
  const bool is_recorded =
      std::ranges::any_of(kept.records, [&](const v1::Record& record) { return says(record, sent); });
  if (is_recorded) return Found::kInLog;
  if (sent.tick <= kept.state->tick()) return Found::kBeforeSnapshot;
  if (sent.command.has_change_scene()) return findScene(sent, kept);
  if (sent.command.has_take_boat()) return findOwner(sent, kept, all);
  return Found::kNowhere;
}

KeptCommands findAll(std::vector<SentCommand> all, const std::string& room, std::uint64_t opening,
                     const history::KeptRoom& kept) {
  std::erase_if(all, [&](const SentCommand& one) { return one.room != room || one.opening != opening; });
  KeptCommands out;
  for (const SentCommand& sent : all) {
    if (sent.state != SentCommand::State::kAcknowledged) continue;
    switch (find(sent, kept, all)) {
      case Found::kInLog:
        ++out.in_log_count;
        break;
      case Found::kBeforeSnapshot:
        ++out.before_snapshot_count;
        break;
      case Found::kNowhere:
        out.lost.push_back(fmt::format(
            "acknowledged at tick {} and lost: {} of person {}; the kept state begins at tick {} and has "
            "{} records",
            sent.tick, sent.command.ShortDebugString(), sent.person_id, kept.state->tick(), kept.records.size()));
    }
  }
  return out;
}

std::optional<v1::KeptState> restoredTwice(history::StateStore& newest, history::StateStore& older,
                                           const std::string& room, const gpu::DeviceChoice& device) {
  auto from_newest = restoredRoom(newest, room, device);
  const auto from_older = restoredRoom(older, room, device, from_newest && *from_newest ? (*from_newest)->tick() : 0);
  for (const auto* restored : {&std::as_const(from_newest), &from_older}) {
    if (*restored && **restored) continue;
    ADD_FAILURE() << (restored == &from_older ? "from the older snapshot: " : "from the newest snapshot: ")
                  << (*restored ? "its files cannot be used" : restored->error().message);
    return std::nullopt;
  }
  EXPECT_THAT(differences(**from_newest, **from_older), testing::IsEmpty());
  return **from_newest;
}

fs::path copyOf(const fs::path& folder, const std::string& name) {
  fs::path copy = folder.parent_path() / name;
  fs::remove_all(copy);
  fs::copy(folder, copy, fs::copy_options::recursive);
  return copy;
}

}  // namespace spindrift::test
