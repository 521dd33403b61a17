#include "directory.h"

#include <future>
#include <utility>

#include <spdlog/spdlog.h>

#include <spindrift/core/room_name.h>

#include "messages.h"

namespace spindrift::cluster {
namespace {

using namespace std::chrono_literals;

/// The server to which a room falls has this time; then any server takes it.
constexpr auto kChosenPatience = 3s;
/// A state without an entry may be that of a room that is being closed.
constexpr auto kStrayPatience = 2s;
constexpr auto kRetryPause = 1s;
/// NATS that takes longer to answer has perhaps not delivered the pulses of the others either.
constexpr auto kPromptAnswer = 200ms;

}  // namespace

Directory::Directory(std::unique_ptr<bus::KeyValues> values, std::string self, Hooks hooks)
    : values_(std::move(values)), self_(std::move(self)), hooks_(std::move(hooks)), worker_(0) {}

Directory::~Directory() = default;

Directory::Entries Directory::parse(const bus::KeyValueMap& values) {
  Entries out;
  for (const auto& [room, value] : values) {
    auto record = cluster::parse<v1::RoomRecord>(value.value);
    if (record && core::isRoomName(room)) out.emplace(room, Entry{*std::move(record), value.revision});
  }
  return out;
}

v1::RoomRecord Directory::recordOf(const rooms::RoomSetup& room) const {
  v1::RoomRecord record;
  record.set_server(self_);
  record.set_scene(room.scene.name());
  record.set_fidelity(room.scene.fidelity());
  return record;
}

void Directory::fail(const std::string& what, const core::Error& error) {
  ++failure_count_;
  if (std::exchange(said_, what + error.message) != what + error.message) spdlog::error("{}: {}", what, error.message);
}

core::Result<std::vector<rooms::RoomSetup>> Directory::claim(std::vector<rooms::RoomSetup> rooms) {
  const auto values = values_->all();
  if (!values) return values.error();
  Entries entries = parse(*values);
  const Servers servers = hooks_.servers();
  const auto now = Clock::now();
  std::vector<rooms::RoomSetup> out;
  for (rooms::RoomSetup& room : rooms) {
    const Entry entry = entries[room.name];
    const std::string& owner = entry.record.server();
    if (!owner.empty() && owner != self_ && servers.isAlive(owner, now)) {
      spdlog::info("room {} runs on server {}; it is not opened here", room.name, owner);
      continue;
    }
    const auto mine = values_->set(room.name, serialize(recordOf(room)), entry.revision);
    if (!mine) return mine.error();
    if (*mine)
      out.push_back(std::move(room));
    else
      spdlog::info("room {} was just taken by another server; it is not opened here", room.name);
  }
  return out;
}

void Directory::open(rooms::RoomSetup setup, rooms::RoomHost::Done done) {
  {
    const std::lock_guard lock(mutex_);
    opening_.insert(setup.name);
  }
  auto shared = std::make_shared<rooms::RoomSetup>(std::move(setup));
  worker_.push([this, shared, done = std::move(done)](bool runs) {
    const std::string name = shared->name;
    const auto finish = [this, name, done](const core::Result<void>& outcome) {
      {
        const std::lock_guard lock(mutex_);
        opening_.erase(name);
      }
      done(outcome);
    };
    if (!runs) return finish(core::unavailable("the server shuts down"));
    closed_.erase(name);
    const auto entered = values_->set(name, serialize(recordOf(*shared)), 0);
    if (!entered) return finish(entered.error());
    if (!*entered) {
      return finish(core::invalid("there is a room '" + name + "' in the cluster already: choose another name"));
    }
    simulation_->openRoom(std::move(*shared), [this, name, finish](const core::Result<void>& opened) {
      if (opened)
        hooks_.opened();
      else
        remove(name);
      finish(opened);
    });
  });
}

void Directory::remove(const std::string& room) {
  worker_.push([this, room](bool runs) {
    if (!runs) return;
    closed_.insert(room);
    if (const auto removed = removeClosed(); !removed)
      fail("room " + room + " was closed and is still in the directory of rooms, its removal is tried again",
           removed.error());
  });
}

core::Result<void> Directory::removeClosed() {
  if (closed_.empty()) return {};
  const auto values = values_->all();
  if (!values) return values.error();
  const Entries entries = parse(*values);
  while (!closed_.empty()) {
    const auto entry = entries.find(*closed_.begin());
    if (entry != entries.end() && entry->second.record.server() == self_) {
      if (auto removed = values_->remove(entry->first); !removed) return removed;
    }
    closed_.erase(closed_.begin());
  }
  return {};
}

void Directory::review() {
  if (!simulation_ || leaving_ || reviewing_.exchange(true)) return;
  worker_.push([this](bool runs) {
    if (runs) reviewNow();
    reviewing_ = false;
  });
}

void Directory::reviewNow() {
  const auto copy = values_->copy();
  if (!copy) {
    was_cut_off_ = true;
    return fail("the directory of rooms cannot be read", copy.error());
  }
  if (std::exchange(was_cut_off_, false)) decides_from_ = Clock::now() + kListenTime;
  if (Clock::now() < decides_from_) return;
  if (const auto removed = removeClosed(); !removed)
    return fail("a room that was closed is still in the directory of rooms", removed.error());
  Entries entries = parse(*copy);
  Decision decision = decide(entries);
  if (decision.settle.empty() && decision.take.empty()) {
    said_.clear();
    return;
  }
  // A server that is cut off hears nobody and sees an old copy, so all others are dead to it: NATS has to answer before
  // anything is decided, and at once.
  const auto asked = Clock::now();
  const auto values = values_->all();
  was_cut_off_ = !values || Clock::now() - asked > kPromptAnswer;
  if (!values) return fail("the directory of rooms cannot be read", values.error());
  said_.clear();
  if (was_cut_off_) return;
  entries = parse(*values);
  decision = decide(entries);
  for (const std::string& room : decision.settle) {
    if (!settle(room, entries.at(room))) return;
  }
  for (const std::string& room : decision.take) {
    if (!take(room, entries.at(room))) return;
  }
}

Directory::Decision Directory::decide(Entries& entries) {
  // Also those that run here without an entry, because NATS lost its data.
  for (const auto& room : simulation_->rooms()) entries.try_emplace(room->name());
  if (const auto& states = simulation_->rules().states) {
    if (const auto kept = states->rooms()) {
      for (const std::string& room : *kept) entries.try_emplace(room);
    }
  }
  const Servers servers = hooks_.servers();
  const auto now = Clock::now();
  Decision out;
  std::map<std::string, int> placed;
  std::map<std::string, Clock::time_point> orphans;
  std::map<std::string, Clock::time_point> disputed;
  for (const auto& [room, entry] : entries) {
    if (simulation_->find(room)) {
      const std::string& other = entry.record.server();
      if (other == self_) continue;
      // Without a shared state the other server may run it, too, or be opening it: after a cut too short to be noticed,
      // its pulses come later than its entry.
      const auto since = disputed_.contains(room) ? disputed_.at(room) : now;
      disputed[room] = since;
      const bool is_free = other.empty() || (!servers.isAlive(other, now) && now - since >= kListenTime);
      if (simulation_->rules().states || is_free || servers.runs(other, room, now)) out.settle.push_back(room);
      continue;
    }
    {
      const std::lock_guard lock(mutex_);
      if (opening_.contains(room)) continue;
    }
    const std::string& owner = entry.record.server();
    if (owner != self_ && servers.isAlive(owner, now)) {
      if (!servers.runs(owner, room, now)) ++placed[owner];  // it has claimed the room and is opening it
      continue;
    }
    // A living server that says that it runs the room will enter it. One that released it is about to end.
    const bool is_released = owner.empty() && entry.revision != 0;
    if (!is_released && servers.isAlive(servers.serverOf(room), now)) continue;
    const auto since = orphans_.contains(room) ? orphans_.at(room) : now;
    orphans[room] = since;
    if (entry.revision == 0 && now - since < kStrayPatience) continue;
    const std::string chosen = servers.choose(now, placed);
    ++placed[chosen];
    if (chosen != self_ && now - since < kChosenPatience) continue;
    {
      const std::lock_guard lock(mutex_);
      const auto retry = retry_after_.find(room);
      if (retry != retry_after_.end() && now < retry->second) continue;
    }
    out.take.push_back(room);
  }
  orphans_ = std::move(orphans);
  disputed_ = std::move(disputed);
  return out;
}

bool Directory::settle(const std::string& room, const Entry& entry) {
  const auto running = simulation_->find(room);
  if (!running) return true;  // closed meanwhile
  const std::string& other = entry.record.server();
  if (hooks_.servers().runs(other, room, Clock::now()) && !simulation_->rules().states) {
    // Without a shared state there is no lock: this server was cut off, and the other one took the room.
    spdlog::error("room {} runs on server {} as well, which took it while this one was cut off: closing it here", room,
                  other);
    simulation_->giveUpRoom(
        room, [this, other](const rooms::Room& given) { hooks_.lost(given.name(), other); },
        [](const core::Result<void>&) {});
    return true;
  }
  v1::RoomRecord record = entry.record;
  record.set_server(self_);
  if (record.scene().empty()) record.set_scene(running->snapshot()->scene.name());
  if (const auto mine = values_->set(room, serialize(record), entry.revision); !mine) {
    fail("room " + room + " could not be entered in the directory of rooms", mine.error());
    return false;
  }
  return true;
}

bool Directory::take(const std::string& room, const Entry& entry) {
  v1::RoomRecord record = entry.record;
  const std::string before = record.server();
  record.set_server(self_);
  const auto mine = values_->set(room, serialize(record), entry.revision);
  if (!mine) {
    fail("room " + room + " could not be taken", mine.error());
    return false;
  }
  if (!*mine) return true;  // another server was faster
  spdlog::warn("room {}: taken over from {}", room,
               before.empty()    ? "nobody"
               : before == self_ ? "this server's earlier run"
                                 : "server " + before);
  rooms::RoomSetup setup{.name = room, .scene = {}, .goes_on = true};
  if (simulation_->rules().scenes.has(record.scene())) {
    const auto fidelity =
        record.fidelity() == v1::FIDELITY_UNSPECIFIED ? std::nullopt : std::optional(record.fidelity());
    if (auto scene = simulation_->rules().scenes.load(record.scene(), fidelity)) setup.scene = *std::move(scene);
  }
  {
    const std::lock_guard lock(mutex_);
    opening_.insert(room);
  }
  simulation_->openRoom(std::move(setup), [this, room](const core::Result<void>& opened) {
    {
      const std::lock_guard lock(mutex_);
      opening_.erase(room);
      if (!opened) retry_after_[room] = Clock::now() + kRetryPause;
    }
    if (opened) {
      ++taken_count_;
      hooks_.opened();
      spdlog::info("room {} runs here now", room);
    } else {
      ++failure_count_;
      spdlog::error("room {} could not be taken over, it is tried again: {}", room, opened.error().message);
    }
  });
  return true;
}

void Directory::release() {
  leaving_ = true;
  std::promise<void> done;
  auto finished = done.get_future();
  worker_.push([this, &done](bool) {
    if (const auto values = values_->all()) {
      for (const auto& [room, entry] : parse(*values)) {
        if (entry.record.server() != self_) continue;
        v1::RoomRecord record = entry.record;
        record.clear_server();
        (void)values_->set(room, serialize(record), entry.revision);
      }
    }
    done.set_value();
  });
  finished.wait();
}

}  // namespace spindrift::cluster
