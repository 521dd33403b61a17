// The simulation thread: owns the GL context and every room, runs each when it is due.
#pragma once

#include <atomic>
#include <condition_variable>
#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <spindrift/core/result.h>
#include <spindrift/gpu/device.h>
#include <spindrift/net/server.h>

#include "encoder_thread.h"
#include "room.h"

namespace spindrift::app {

class SimulationThread {
 public:
  /// Makes the context and the rooms on the new thread and waits for that; errors are the device's and the rooms'.
  static core::Result<std::unique_ptr<SimulationThread>> start(const gpu::DeviceChoice& device,
                                                               std::vector<RoomSetup> setups, SceneCatalog scenes = {});
  ~SimulationThread();
  SimulationThread(const SimulationThread&) = delete;
  SimulationThread& operator=(const SimulationThread&) = delete;

  /// Time begins to run; all must live until stop().
  void run(net::Hub& hub, EncoderThread& encoder, RoomObserver& observer);
  /// Ends the thread; the rooms and the context are gone afterwards. Idempotent.
  void stop();

  /// In the order they were given; valid until the destructor, their any-thread functions after stop() too.
  [[nodiscard]] const std::vector<std::unique_ptr<Room>>& rooms() const { return rooms_; }
  /// Null if there is none of this name; the empty name is the first room.
  [[nodiscard]] Room* find(const std::string& name) const;
  /// What rooms can be changed to.
  [[nodiscard]] const SceneCatalog& scenes() const { return scenes_; }
  /// What the simulation runs on and why, one line.
  [[nodiscard]] const std::string& deviceLine() const { return device_line_; }
  /// One line a room for the summary; filled by stop().
  [[nodiscard]] const std::vector<std::string>& summary() const { return summary_; }

 private:
  SimulationThread() = default;
  core::Result<void> build(const gpu::DeviceChoice& device, std::vector<RoomSetup> setups);
  void loop();

  SceneCatalog scenes_;
  std::unique_ptr<gpu::Context> context_;
  std::vector<std::unique_ptr<Room>> rooms_;
  std::string device_line_;
  std::vector<std::string> summary_;
  net::Hub* hub_ = nullptr;
  EncoderThread* encoder_ = nullptr;
  RoomObserver* observer_ = nullptr;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace spindrift::app
