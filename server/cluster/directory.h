// The directory of rooms, which all servers share: who runs which room, and who takes one that nobody runs. Each server
// reads a copy of it that NATS keeps up to date (bus::KeyValues), and asks NATS only before it changes something.
#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include <spindrift/bus/key_values.h>
#include <spindrift/core/worker.h>
#include <spindrift/rooms/room_host.h>
#include <spindrift/v1/cluster.pb.h>

#include "placement.h"

namespace spindrift::cluster {

/// Public calls are for any thread; the work is done on a thread of its own, because the directory may take its time.
class Directory {
 public:
  struct Hooks {
    std::function<Servers()> servers;  ///< returns what is known of the servers now
    std::function<void()> opened;      ///< a room was opened here; called before anybody is told
    /// A room ends here because another server runs it: its sessions have to connect again.
    std::function<void(const std::string& room, const std::string& server)> lost;
  };

  /// Objects that the hooks use outlive it. `self`: the name of this server.
  Directory(std::unique_ptr<bus::KeyValues> values, std::string self, Hooks hooks);
  ~Directory();
  Directory(const Directory&) = delete;
  Directory& operator=(const Directory&) = delete;

  /// As Node::claim(); on the calling thread, before serve().
  core::Result<std::vector<rooms::RoomSetup>> claim(std::vector<rooms::RoomSetup> rooms);
  void serve(rooms::RoomHost& simulation) { simulation_ = &simulation; }
  /// Enters the room and opens it here; removes the entry if that fails.
  void open(rooms::RoomSetup setup, rooms::RoomHost::Done done);
  /// The room was closed for good here. Its entry stays if it is another server's.
  void remove(const std::string& room);
  /// Looks for rooms that nobody runs and takes those that fall to this server. One review at a time; further calls
  /// meanwhile do nothing.
  void review();
  /// Takes no rooms any more.
  void leave() { leaving_ = true; }
  /// Lets others take the rooms of this server; waits.
  void release();

  [[nodiscard]] std::uint64_t takenCount() const { return taken_count_; }
  [[nodiscard]] std::uint64_t failureCount() const { return failure_count_; }

 private:
  struct Entry {
    v1::RoomRecord record;
    std::uint64_t revision = 0;  ///< 0: only the room's state is there, in the shared folder
  };
  using Entries = std::map<std::string, Entry>;
  static Entries parse(const bus::KeyValueMap& values);
  /// Returns the entry of a room that runs here.
  [[nodiscard]] v1::RoomRecord recordOf(const rooms::RoomSetup& room) const;
  void reviewNow();
  /// Removes the entries of closed rooms.
  core::Result<void> removeClosed();
  /// Work of a review, by the rooms' names.
  struct Decision {
    std::vector<std::string> settle;  ///< they run here, and the directory says otherwise
    std::vector<std::string> take;
  };
  /// Adds the rooms that run here and those in the shared folder to the entries, then decides.
  Decision decide(Entries& entries);
  /// False: the directory could not be written.
  bool settle(const std::string& room, const Entry& entry);
  bool take(const std::string& room, const Entry& entry);
  void fail(const std::string& what, const core::Error& error);

  const std::unique_ptr<bus::KeyValues> values_;
  const std::string self_;
  const Hooks hooks_;
  rooms::RoomHost* simulation_ = nullptr;
  std::atomic<bool> leaving_{false};
  std::atomic<bool> reviewing_{false};
  std::atomic<std::uint64_t> taken_count_{0};
  std::atomic<std::uint64_t> failure_count_{0};
  std::mutex mutex_;
  std::set<std::string> opening_;                         ///< guarded by mutex_
  std::map<std::string, Clock::time_point> orphans_;      ///< since when; on the worker
  std::map<std::string, Clock::time_point> disputed_;     ///< run here, and another server has entered them; likewise
  std::set<std::string> closed_;                          ///< for good, but perhaps still entered; on the worker
  std::map<std::string, Clock::time_point> retry_after_;  ///< rooms that could not be opened here; under mutex_
  bool was_cut_off_ = false;                              ///< on the worker, like the next one
  Clock::time_point decides_from_{};                      ///< not before it has heard the others
  std::string said_;                                      ///< the last failure, not to repeat it; on the worker
  core::Worker worker_;                                   ///< last: ends first
};

}  // namespace spindrift::cluster
