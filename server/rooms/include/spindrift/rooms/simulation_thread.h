// The thread that runs every room. Rooms open and close meanwhile, their water is built by another thread; others reach
// them through shared pointers and use only their any-thread functions.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <spindrift/core/result.h>
#include <spindrift/gpu/device.h>
#include <spindrift/rooms/room.h>
#include <spindrift/rooms/water_builder.h>

namespace spindrift::rooms {

class SimulationThread {
 public:
  /// Makes the rooms, which speak to `outlets` once run() was called, and waits for that; errors are the device's and
  /// the rooms'.
  static core::Result<std::unique_ptr<SimulationThread>> start(const gpu::DeviceChoice& device,
                                                               std::vector<RoomSetup> setups, RoomRules rules,
                                                               std::size_t max_room_count, RoomOutlets& outlets);
  ~SimulationThread();
  SimulationThread(const SimulationThread&) = delete;
  SimulationThread& operator=(const SimulationThread&) = delete;

  /// Time begins to run; the outlets must live until stop().
  void run();
  /// Ends the thread; the rooms' water and the context are gone afterwards, changes that wait are told so. Idempotent.
  void stop();

  /// In the order they were opened; the first is the default room.
  [[nodiscard]] std::vector<std::shared_ptr<Room>> rooms() const;
  /// Null if there is none of this name; the empty name is the default room.
  [[nodiscard]] std::shared_ptr<Room> find(const std::string& name) const;

  /// Called on this thread when a room was opened or closed, or could not be.
  using Done = std::function<void(core::Result<void>)>;
  /// Opens a room, whose water is built beside the running ones. Errors: kInvalidInput for a name
  /// that is taken, kUnavailable when there are as many as may be or too many changes wait, else the scene's.
  void openRoom(RoomSetup setup, Done done);
  /// Closes a room: `before` is called first, on this thread, with the room still there. Errors: kInvalidInput for a
  /// name that is not there or the default room.
  void closeRoom(std::string name, std::function<void(const Room&)> before, Done done);

  /// What rooms have in common.
  [[nodiscard]] const RoomRules& rules() const { return rules_; }
  [[nodiscard]] std::size_t maxRoomCount() const { return max_room_count_; }
  /// Seconds since every room was last looked after; large while the thread is stuck or compiles.
  [[nodiscard]] double sinceLastRound_s() const;
  /// What the simulation runs on and why, one line.
  [[nodiscard]] const std::string& deviceLine() const { return device_line_; }
  /// One line a room for the summary; filled by stop().
  [[nodiscard]] const std::vector<std::string>& summary() const { return summary_; }

 private:
  /// Carried out by the thread between two rounds; called with false when it never will be.
  using Change = std::function<void(bool runs)>;

  /// A room whose water is being built.
  struct Opening {
    std::string name;
    std::future<WaterBuilder::Built> water;
    Done done;
  };

  explicit SimulationThread(RoomOutlets& outlets) : outlets_(outlets) {}
  core::Result<void> build(std::vector<RoomSetup> setups);
  void loop();
  void carryOut(Change change, const Done& done);
  /// Begins to open a room; `done` may be called at once, with an error.
  void open(RoomSetup setup, Done done);
  /// Finishes the openings whose water is there.
  void finishOpenings();
  core::Result<void> add(std::string name, WaterBuilder::Built water);
  core::Result<void> close(const std::string& name, const std::function<void(const Room&)>& before);
  void summarise(const Room& room);

  RoomOutlets& outlets_;
  RoomRules rules_;
  std::size_t max_room_count_ = 0;
  std::unique_ptr<WaterBuilder> builder_;
  std::vector<Opening> openings_;  ///< of the thread
  mutable std::mutex rooms_mutex_;
  std::vector<std::shared_ptr<Room>> rooms_;
  std::string device_line_;
  std::vector<std::string> summary_;
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<Change> changes_;
  std::chrono::steady_clock::time_point last_round_{};
  bool was_built_ = false;  ///< the builder has finished something since the last round
  bool running_ = false;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace spindrift::rooms
