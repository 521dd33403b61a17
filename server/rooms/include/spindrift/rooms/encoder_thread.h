// The encoder thread: takes finished frames and publishes one shared message per (layer, packing, level) that is
// watched.
#pragma once

#include <array>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <spindrift/codec/frame_encoder.h>
#include <spindrift/codec/stream.h>
#include <spindrift/core/demand_table.h>
#include <spindrift/core/frame_view.h>
#include <spindrift/core/level.h>

namespace spindrift::rooms {

/// Receives encoded frames, on a thread of the encoder, those of a room on one at a time; must not block.
class FrameOutlet {
 public:
  virtual ~FrameOutlet() = default;

  /// Sends the data of one level of a frame to the sessions that take it. `levels`: which these are.
  virtual void publish(const std::string& room, codec::Stream stream, const codec::EncodedFrame& frame,
                       const core::FrameLevels& levels) = 0;
};

/// Encodes frames in the order of their rooms' arrival, those of a room one after the other. At most one frame waits
/// per room: a newer one replaces it in its place of the queue, and the loss is counted. So no room waits for more than
/// one frame of each other room. A machine with many processors has several threads, so that a room whose frames take
/// long (25 ms for a million particles) does not hold up the others.
class EncoderThread {
 public:
  /// A thread for every four processors, at most four.
  explicit EncoderThread(FrameOutlet& outlet);
  EncoderThread(FrameOutlet& outlet, unsigned thread_count);
  ~EncoderThread();
  EncoderThread(const EncoderThread&) = delete;
  EncoderThread& operator=(const EncoderThread&) = delete;

  /// Any thread; never waits for encoding. Encodes what `demand` asks for at that time.
  void submit(const std::string& room, std::shared_ptr<const core::DemandTable> demand, core::FrameView frame);
  /// Call it when the room was closed.
  void forget(const std::string& room);
  /// Ends the threads. Waiting frames and those submitted later are dropped. Idempotent.
  void stop();

  struct FrameCounts {
    std::uint64_t encoded_count = 0;
    std::uint64_t replaced_count = 0;  ///< by a newer frame, before they were encoded
  };
  /// Returns the counts of a room since it opened; zeros for a room without frames.
  [[nodiscard]] FrameCounts frameCounts(const std::string& room) const;

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
  struct Waiting {
    std::string room;
    std::shared_ptr<const core::DemandTable> demand;
    core::FrameView frame;
  };
  struct KnownRoom {
    std::shared_ptr<codec::FrameEncoder> encoder;  ///< used by the thread that has made the room busy
    bool is_busy = false;
    FrameCounts counts;
  };

  void loop();
  /// Returns the first frame whose room is not being encoded.
  std::deque<Waiting>::iterator next();
  /// Encodes the watched streams and levels of a frame and publishes them.
  Costs encode(const Waiting& job, codec::FrameEncoder& encoder);

  FrameOutlet& outlet_;
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<Waiting> waiting_;  ///< oldest first, at most one per room
  std::map<std::string, KnownRoom> rooms_;
  bool stopping_ = false;
  Costs costs_{};
  std::vector<std::thread> threads_;
};

}  // namespace spindrift::rooms
