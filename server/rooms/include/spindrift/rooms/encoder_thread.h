// The encoder's thread: finished frames in, one shared message a layer out, to whoever watches.
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

/// Holds at most one waiting frame a room: a newer one replaces it, and the loss is counted.
class EncoderThread {
 public:
  explicit EncoderThread(FrameOutlet& outlet);
  ~EncoderThread();
  EncoderThread(const EncoderThread&) = delete;
  EncoderThread& operator=(const EncoderThread&) = delete;

  /// Any thread; never blocks on encoding.
  void submit(const std::string& room, core::FrameView frame);
  /// The room is no more.
  void forget(const std::string& room);
  /// Ends the thread; frames still waiting, and those submitted afterwards, are dropped. Idempotent.
  void stop();

  [[nodiscard]] std::uint64_t replacedCount() const;
  /// Messages encoded for a stream of a room so far: one a frame and level, however many clients watch.
  [[nodiscard]] std::uint64_t encodeCount(const std::string& room, codec::Stream stream) const;

  /// Cost of one level of a stream, summed over all rooms since the start.
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
  /// Encodes what somebody watches of a frame, and publishes it.
  Costs encode(const std::string& room, const core::FrameView& frame, codec::FrameEncoder& encoder);

  FrameOutlet& outlet_;
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::map<std::string, core::FrameView> waiting_;
  std::uint64_t replaced_count_ = 0;
  bool stopping_ = false;
  /// Grows and shrinks under mutex_; used by the thread.
  std::map<std::string, std::shared_ptr<codec::FrameEncoder>> encoders_;
  Costs costs_{};
  std::thread thread_;
};

}  // namespace spindrift::rooms
