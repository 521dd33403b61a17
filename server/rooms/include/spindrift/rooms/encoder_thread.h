// The encoder thread: takes finished frames and publishes one shared message per (layer, packing, level) that is
// watched.
#pragma once

#include <array>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include <spindrift/codec/frame_encoder.h>
#include <spindrift/core/frame_view.h>
#include <spindrift/rooms/frame_outlet.h>

namespace spindrift::rooms {

/// Holds at most one waiting frame per room; a newer one replaces it, and the loss is counted.
class EncoderThread {
 public:
  explicit EncoderThread(FrameOutlet& outlet);
  ~EncoderThread();
  EncoderThread(const EncoderThread&) = delete;
  EncoderThread& operator=(const EncoderThread&) = delete;

  /// Any thread; never waits for encoding.
  void submit(const std::string& room, core::FrameView frame);
  /// Call it when the room was closed.
  void forget(const std::string& room);
  /// Ends the thread. Waiting frames and those submitted later are dropped. Idempotent.
  void stop();

  [[nodiscard]] std::uint64_t replacedCount() const;

  /// Cost of one level of a stream, summed over all rooms since the start. Each frame counts once, for any number of
  /// clients.
  struct StreamCost {
    std::uint64_t frame_count = 0;
    std::uint64_t bytes_count = 0;
    double encode_s = 0.0;
  };
  /// By codec::indexOf() and core::indexOf().
  using Costs = std::array<std::array<StreamCost, core::kLevelCount>, codec::kStreamCount>;
  [[nodiscard]] Costs costs() const;

 private:
  void loop();
  /// Encodes the watched streams and levels of a frame and publishes them.
  Costs encode(const std::string& room, const core::FrameView& frame, codec::FrameEncoder& encoder);

  FrameOutlet& outlet_;
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::map<std::string, core::FrameView> waiting_;
  std::uint64_t replaced_count_ = 0;
  bool stopping_ = false;
  /// Changed under mutex_; the encoders are used by the thread.
  std::map<std::string, std::shared_ptr<codec::FrameEncoder>> encoders_;
  Costs costs_{};
  std::thread thread_;
};

}  // namespace spindrift::rooms
