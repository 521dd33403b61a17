// One recording of one room: takes the frames that its sessions get, as one more of them, and writes them on a thread
// of its own.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <spindrift/codec/frame_encoder.h>
#include <spindrift/core/demand_table.h>
#include <spindrift/recording/water_recorder.h>
#include <spindrift/v1/api.pb.h>

namespace spindrift::service {

struct RoomRecordingSetup {
  std::string name;
  std::string room;
  std::shared_ptr<core::DemandTable> demand;  ///< of the room
  std::vector<codec::Stream> streams;
  core::Level level = core::Level::kFull;
  std::uint64_t max_bytes = 0;  ///< of the recorder
};

/// Thread-safe. Messages for which the disk is too slow are dropped and counted; a packed layer begins again with a
/// keyframe, which is asked for when half of the queue is free.
class RoomRecording {
 public:
  static constexpr std::size_t kWaitingMaxBytes = 64u << 20;
  static constexpr std::size_t kWaitingMaxCount = 4096;
  /// After end(), messages that wait are written for this time; the rest is dropped.
  static constexpr std::chrono::seconds kEndMax{5};

  /// Says in the demand of the room what it needs; the caller wakes the room then.
  RoomRecording(RoomRecordingSetup setup, std::unique_ptr<recording::WaterRecorder> recorder,
                const core::SharedBytes& greeting);
  /// Ends it and waits for the files.
  ~RoomRecording();
  RoomRecording(const RoomRecording&) = delete;
  RoomRecording& operator=(const RoomRecording&) = delete;

  [[nodiscard]] const std::string& room() const { return setup_.room; }
  [[nodiscard]] std::uint64_t maxBytes() const { return setup_.max_bytes; }
  [[nodiscard]] bool isRunning() const;
  [[nodiscard]] v1::Recording state() const;

  void publish(codec::Stream stream, const codec::EncodedFrame& frame, const core::FrameLevels& levels);
  void tell(const core::SharedBytes& message);
  /// The first reason counts. `done` is called when the files are finished, on the thread of the recording.
  void end(const std::string& why, std::function<void()> done = {});

 private:
  struct Slot {
    codec::Stream stream;
    bool follows = false;                    ///< the last frame was taken: a delta can continue it
    bool wants_keyframe = false;             ///< the next keyframe is taken also where a delta could follow
    core::Level level = core::Level::kFull;  ///< of the data of the last frame
  };

  void loop();
  /// Records until the end; returns why it ended. Error: that of the disk.
  core::Result<std::string> record();
  // Call with the mutex held.
  bool push(const core::SharedBytes& message);
  void tellNeed(const Slot& slot);
  void setCounts();

  const RoomRecordingSetup setup_;
  const std::unique_ptr<recording::WaterRecorder> recorder_;  ///< used by the thread only

  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::vector<Slot> slots_;
  std::deque<core::SharedBytes> waiting_;
  std::size_t waiting_bytes_ = 0;
  std::optional<std::string> end_;  ///< asked for
  std::chrono::steady_clock::time_point end_by_{};
  std::vector<std::function<void()>> done_;
  v1::Recording state_;
  std::thread thread_;
};

}  // namespace spindrift::service
