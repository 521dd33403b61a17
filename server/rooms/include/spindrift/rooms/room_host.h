// All rooms of a server: opens and closes them on a thread of its own while each runs on its own (RoomThread); another
// thread builds their water. Other threads hold rooms by shared pointers and call only their any-thread functions.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <spindrift/core/result.h>
#include <spindrift/core/room_name.h>
#include <spindrift/gpu/device.h>
#include <spindrift/rooms/room.h>
#include <spindrift/rooms/room_opener.h>
#include <spindrift/rooms/room_thread.h>
#include <spindrift/water/water_builder.h>

namespace spindrift::rooms {

/// Notices that somebody set the clock of the system: compares it with one that nobody sets. Both run at nearly the
/// same rate: corrections by NTP are below 0.05 %, so only a step makes them differ by seconds between two calls.
class ClockWatch {
 public:
  using Seconds = std::chrono::duration<double>;

  /// Returns by how much the system's clock was set since the last call, positive for forward; nothing if it was not.
  /// Steps below kLeast are not reported.
  std::optional<Seconds> step(std::chrono::system_clock::time_point wall,
                              std::chrono::steady_clock::time_point steady) {
    const Seconds offset = Seconds(wall.time_since_epoch()) - Seconds(steady.time_since_epoch());
    const Seconds step = offset - offset_.value_or(offset);
    offset_ = offset;
    if (std::chrono::abs(step) < kLeast) return std::nullopt;
    return step;
  }

 private:
  static constexpr Seconds kLeast{2.0};
  std::optional<Seconds> offset_;
};

class RoomHost {
 public:
  /// Makes the rooms and waits for them, with RoomRules::states also those that were kept on disk. They call `outlets`
  /// only after run(). Errors: those of the device and the rooms; kInvalidInput for more rooms than `max_room_count`.
  static core::Result<std::unique_ptr<RoomHost>> start(const gpu::DeviceChoice& device, std::vector<RoomSetup> setups,
                                                       RoomRules rules, std::size_t max_room_count,
                                                       RoomOutlets& outlets);
  ~RoomHost();
  RoomHost(const RoomHost&) = delete;
  RoomHost& operator=(const RoomHost&) = delete;

  /// Starts simulated time; `outlets` must live until stop().
  void run();
  /// Ends the thread and destroys the rooms' water and the context; waiting changes are reported as failed. Does not
  /// wait for a build of water, as the destructor does: on a busy machine it takes minutes, at its low priority.
  /// Idempotent.
  void stop();
  /// Returns whether water is still being built or destroyed.
  [[nodiscard]] bool isBuilding() const { return !builder_->hasEnded(); }

  /// Returns the rooms in the order of opening; the first is the default room.
  [[nodiscard]] std::vector<std::shared_ptr<Room>> rooms() const;
  /// Returns the room, or null if it does not exist; the empty name is the default room.
  [[nodiscard]] std::shared_ptr<Room> find(const std::string& name) const;

  /// Called on this thread when a room was opened or closed, or with the error.
  using Done = std::function<void(core::Result<void>)>;
  /// Opens a room after its water was built, while the other rooms run. Errors: kInvalidInput for a name that is taken,
  /// kUnavailable when the number of rooms or of waiting changes is at its limit, otherwise those of the scene.
  void openRoom(RoomSetup setup, const Done& done);
  /// Closes a room; `before` is called first, on this thread, while the room still exists. Error: kInvalidInput for an
  /// unknown name or the default room.
  void closeRoom(std::string name, std::function<void(const Room&)> before, const Done& done);
  /// Closes a room that another process runs, also the default room. Its files, if there are any, stay.
  void giveUpRoom(std::string name, std::function<void(const Room&)> before, const Done& done);

  /// Settings shared by all rooms.
  [[nodiscard]] const RoomRules& rules() const { return rules_; }
  /// Returns the seconds for which a room, or the thread that opens rooms, has not come further; large while one is
  /// stuck.
  [[nodiscard]] double sinceLastRound_s() const;
  /// One line: the device and why it was chosen. Empty until the first room was opened.
  [[nodiscard]] std::string deviceLine() const;
  /// Time that the threads of all rooms worked lately, over that of all processors.
  [[nodiscard]] double busyShare() const;
  /// Returns how many waters could not be built since the start, for one cause.
  [[nodiscard]] std::uint64_t waterFailureCount(core::ErrorCode cause) const { return builder_->failureCount(cause); }
  /// Returns how often the system's clock was set while the rooms ran.
  [[nodiscard]] std::uint64_t clockStepCount() const { return clock_step_count_; }
  /// One line per room; filled by stop().
  [[nodiscard]] const std::vector<std::string>& summary() const { return summary_; }

 private:
  /// Runs on the thread between two rounds; if it will not run, `done` gets the error.
  struct Change {
    std::function<void()> run;
    Done done;
  };

  explicit RoomHost(RoomOutlets& outlets) : outlets_(outlets) {}
  core::Result<void> build(std::vector<RoomSetup> setups);
  [[nodiscard]] core::Error tooManyRooms(const std::set<std::string>& names) const;
  void loop();
  /// Ends the wait between two rounds. Any thread.
  void wake();
  void carryOut(Change change);
  /// Starts opening a room; `done` may be called at once, with an error.
  void open(RoomSetup setup, Done done);
  /// Continues with the openings.
  void advanceOpenings();
  /// Returns whether the room can run.
  core::Result<bool> advance(RoomOpener::Opening& opening);
  /// The room gets its thread, which start() has to be called for once the server runs.
  void add(std::shared_ptr<Room> room);
  [[nodiscard]] ServerLoad loadOf(const RoomThread& thread) const;
  core::Result<void> close(const std::string& name, const std::function<void(const Room&)>& before);
  void end(const std::shared_ptr<Room>& room, const std::function<void(const Room&)>& before);

  RoomOutlets& outlets_;
  RoomRules rules_;
  std::size_t max_room_count_ = 0;
  // Before the builder, whose thread uses them until it has ended.
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  bool is_woken_ = false;  ///< since the last round: the builder has finished a piece of work
  mutable std::mutex rooms_mutex_;
  std::vector<std::unique_ptr<RoomThread>> threads_;  ///< of the open rooms; guarded by rooms_mutex_
  std::unique_ptr<water::WaterBuilder> builder_;
  std::unique_ptr<RoomOpener> opener_;         ///< used by the thread only
  std::vector<RoomOpener::Opening> openings_;  ///< likewise
  /// Never closed: the first of those at the start. In a cluster none begins here, and it may run elsewhere.
  std::string default_room_{core::kDefaultRoom};
  std::string device_line_;  ///< guarded by rooms_mutex_
  std::vector<std::string> summary_;
  std::deque<Change> changes_;
  std::chrono::steady_clock::time_point last_round_{};
  ClockWatch clock_watch_;  ///< used by the thread only
  std::atomic<std::uint64_t> clock_step_count_{0};
  bool running_ = false;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace spindrift::rooms
