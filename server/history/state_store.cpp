#include <utility>

#include <google/protobuf/stubs/logging.h>
#include <spdlog/spdlog.h>

#include <spindrift/core/room_name.h>
#include <spindrift/core/text.h>
#include <spindrift/history/state_store.h>
#include <spindrift/state/folders.h>

namespace spindrift::history {
namespace {

/// Lower priority than the ticks of running rooms.
constexpr int kWriterNiceness = 5;

template <typename Message>
bool parse(Message& message, core::ByteView bytes) {
  const google::protobuf::LogSilencer silencer;
  return message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()));
}

/// Records after the first one that is not a message are not used: each changes what the later ones mean.
std::vector<v1::Record> parseRecords(const std::string& room, const std::vector<state::RoomFiles::Log>& logs) {
  std::vector<v1::Record> out;
  for (const state::RoomFiles::Log& log : logs) {
    for (const core::ByteView bytes : log.records) {
      v1::Record record;
      if (!parse(record, bytes)) {
        spdlog::error(
            "room {}: record {} of its state is of another version of this program; it and the later ones are not used",
            room, out.size() + 1);
        return out;
      }
      out.push_back(std::move(record));
    }
  }
  return out;
}

/// Returns why the room cannot continue from the snapshot, or an empty string.
std::string read(core::ByteView snapshot, const std::string& room, v1::KeptState& state) {
  if (!parse(state, snapshot)) return "it is not a state of a room, or of another version of this program";
  if (state.room() == room) return "";
  return "it is of the room '" + core::cleanText(state.room(), core::kRoomNameMaxBytes) + "'";
}

/// Names the folders that are not rooms, once.
void warnAboutNames(const std::filesystem::path& folder) {
  const auto listed = state::listRooms(folder);
  if (!listed) return;
  for (const std::string& name : listed->refused_names) {
    spdlog::warn("the folder '{}' in {} is not opened: a room's name has {}; rename the folder, or remove it",
                 core::cleanText(name, 4 * core::kRoomNameMaxBytes), (folder / "rooms").string(), core::kRoomNameRule);
  }
}

}  // namespace

core::Result<std::shared_ptr<StateStore>> StateStore::open(const StateOptions& options) {
  warnAboutNames(options.folder);
  // A removal that was cut off in a shared folder is finished by the next one of a room of that name.
  if (options.is_shared) return std::shared_ptr<StateStore>(new StateStore(options, nullptr));
  auto lock = state::lockFolder(options.folder);
  if (!lock) return lock.error();
  if (auto finished = state::finishRemovals(options.folder); !finished) return finished.error();
  return std::shared_ptr<StateStore>(new StateStore(options, *std::move(lock)));
}

StateStore::StateStore(StateOptions options, state::FolderLock lock)
    : options_(std::move(options)), lock_(std::move(lock)), writer_(kWriterNiceness) {}

core::Result<std::vector<std::string>> StateStore::rooms() const {
  auto listed = state::listRooms(options_.folder);
  if (!listed) return listed.error();
  return std::move(listed->names);
}

core::Result<state::FolderLock> StateStore::lockRoom(const std::string& room) const {
  if (!options_.is_shared) return state::FolderLock();
  return state::lockFolder(options_.folder / "locks" / room);
}

core::Result<RoomPlace> StateStore::place(const std::string& room, std::uint64_t before) {
  const auto folder = state::roomFolder(options_.folder, room);
  if (!folder) return folder.error();
  auto room_lock = lockRoom(room);
  if (!room_lock) return room_lock.error();
  RoomPlace out;
  auto files = state::RoomFiles::open(*folder, room,
                                      {.sync = options_.sync, .kept_generation_count = options_.kept_generation_count});
  if (!files) return files.error();
  bool has_refused = before != state::RoomFiles::kNewest;
  while (true) {
    auto recovered = (*files)->recover(before);
    if (!recovered) return recovered.error();
    for (const std::string& note : recovered->notes) spdlog::warn("room {}: {}", room, note);
    if (recovered->generation == 0) break;
    v1::KeptState state;
    const std::string why = read(recovered->snapshot, room, state);
    if (why.empty()) {
      out.kept = KeptRoom{std::make_shared<const v1::KeptState>(std::move(state)), parseRecords(room, recovered->logs)};
      out.generation = recovered->generation;
      break;
    }
    spdlog::error("room {}: its snapshot {} cannot be used: {}; an older one is tried", room, recovered->generation,
                  why);
    before = recovered->generation;
    has_refused = true;
  }
  if (has_refused && !out.kept) {
    files->reset();  // they hold no file yet
    room_lock->reset();
    const auto aside = setAside(room);
    if (!aside) return aside.error();
    spdlog::error("room {}: none of its snapshots can be used; its files are now in {}", room, aside->string());
    return place(room);
  }
  out.keeper = std::make_unique<StateKeeper>(room, *std::move(files), options_.snapshot_interval, writer_,
                                             *std::move(room_lock));
  return out;
}

core::Result<std::filesystem::path> StateStore::setAside(const std::string& room) const {
  return state::setRoomAside(options_.folder, room);
}

core::Result<void> StateStore::remove(const std::string& room) const {
  return state::removeRoom(options_.folder, room);
}

core::Result<void> StateStore::removeUnused(const std::string& room) const {
  const auto room_lock = lockRoom(room);
  if (!room_lock) return {};  // another server uses it
  const auto has_state = state::hasState(options_.folder, room);
  if (!has_state) return has_state.error();
  return *has_state ? core::Result<void>() : remove(room);
}

}  // namespace spindrift::history
