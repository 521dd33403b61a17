// The directory of rooms, which all servers share: who runs which room, and who takes one that nobody runs. Each server
// reads a copy of it that NATS keeps up to date (bus::KeyValues), and asks NATS only before it changes something.
#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <spindrift/bus/key_values.h>
#include <spindrift/rooms/simulation_thread.h>
#include <spindrift/rooms/worker.h>
#include <spindrift/v1/cluster.pb.h>

#include "placement.h"

namespace spindrift::cluster {

/// Public calls are for any thread; the work is done on a thread of its own, because the directory may take its time.
class Directory {
 public:
  using LookAt = std::function<Servers()>;  ///< returns what is known of the servers now
  using Opened = std::function<void()>;     ///< a room was opened here; called before anybody is told

  /// `values` and what the functions need outlive it. `self`: the name of this server.
  Directory(std::unique_ptr<bus::KeyValues> values, std::string self, LookAt servers, Opened opened);
  ~Directory();
  Directory(const Directory&) = delete;
  Directory& operator=(const Directory&) = delete;

  /// As Node::claim(); on the calling thread, before serve().
  core::Result<std::vector<rooms::RoomSetup>> claim(std::vector<rooms::RoomSetup> rooms);
  void serve(rooms::SimulationThread& simulation) { simulation_ = &simulation; }
  /// Enters the room and opens it here; removes the entry if that fails.
  void open(rooms::RoomSetup setup, rooms::SimulationThread::Done done);
  /// The room was closed for good.
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
  core::Result<bool> write(const std::string& room, const v1::RoomRecord& record, std::uint64_t revision);
  void reviewNow();
  /// What a review has to do, by the rooms' names.
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
  const LookAt servers_;
  const Opened opened_;
  rooms::SimulationThread* simulation_ = nullptr;
  std::atomic<bool> leaving_{false};
  std::atomic<bool> reviewing_{false};
  std::atomic<std::uint64_t> taken_count_{0};
  std::atomic<std::uint64_t> failure_count_{0};
  std::mutex mutex_;
  std::set<std::string> opening_;                         ///< guarded by mutex_
  std::map<std::string, Clock::time_point> orphans_;      ///< since when; on the worker
  std::set<std::string> removed_;                         ///< closed for good, but still entered; on the worker
  std::map<std::string, Clock::time_point> retry_after_;  ///< rooms that could not be opened here; under mutex_
  std::string said_;                                      ///< the last failure, not to repeat it; on the worker
  rooms::Worker worker_;                                  ///< last: ends first
};

}  // namespace spindrift::cluster
