// What waits to be sent to one session. Producers on any thread put messages in, the session's writer takes them out
// one at a time. Bounded by construction: `control_queue_count` control messages and one frame per layer, whatever the
// client does, and without a task queued per frame.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string>

#include <spindrift/core/bytes.h>
#include <spindrift/net/server.h>

#include "rate_limit.h"

namespace spindrift::net {

/// Thread-safe. Two planes: control (ordered, never dropped) goes before data (newest frame per layer, layers in turn).
class Outbox {
 public:
  explicit Outbox(std::size_t control_queue_count) : control_queue_count_(control_queue_count) {}

  /// What a producer has to do after a call.
  struct Outcome {
    bool wake = false;      ///< the writer sleeps: wake it
    bool dropped = false;   ///< an unsent older frame was replaced
    bool overflow = false;  ///< the control queue was full: this call has asked for kTryAgainLater
  };

  /// Appends to the control plane. A message that finds the queue full is lost, and the session with it: a close with
  /// kTryAgainLater follows what is queued. Ignored once a close was asked for.
  Outcome pushControl(core::SharedBytes message);

  /// Puts the frame into its layer's slot if the session watches the layer and its rate allows: the continuing form if
  /// the client has what it builds on, else the whole one. Without a whole one an unsent older frame is dropped and the
  /// session waits. Ignored once a close was asked for.
  Outcome offerFrame(LayerIndex layer, const LayerBytes& frame, Clock::time_point now);

  /// Whether the next frame of the layer would be taken, but only whole. False for a session that has read nothing
  /// since it lost one: what it cannot take is not made for it.
  bool wantsWhole(LayerIndex layer, Clock::time_point now) const;

  /// Starts a layer at this rate, or stops it (nullopt) and forgets its unsent frame.
  void setWatch(LayerIndex layer, std::optional<double> max_rate_hz);

  /// Forgets unsent frames (they belong to a room that the session left).
  void clearFrames();

  /// Asks for a close after the queued control messages; unsent frames are forgotten. The first request counts.
  /// True if this was the first.
  bool requestClose(CloseCode code, std::string reason);

  /// The connection is gone: next() answers kShut from now on.
  void shut();

  enum class Kind { kIdle, kControl, kFrame, kClose, kShut };
  struct Next {
    Kind kind = Kind::kIdle;
    core::SharedBytes message;  ///< for kControl and kFrame
  };

  /// The next thing to do. kIdle means the writer goes to sleep: the next producer gets `wake`.
  Next next();

  struct Waiting {
    std::size_t control_count = 0;
    std::size_t frame_count = 0;
  };
  Waiting waiting() const;

  bool closing() const;
  /// Code and line of the first requestClose(); nullopt before.
  std::optional<SessionEnd> closeRequest() const;

 private:
  /// With the mutex held: true once after the writer said it sleeps.
  bool takeWake();

  struct Slot {
    std::optional<RateGate> gate;  ///< empty = not watched
    core::SharedBytes frame;
    bool follows = false;                    ///< the client has the last frame, or will have it with `frame`
    std::optional<std::uint64_t> lost_turn;  ///< turn_count_ when a frame was lost for want of a whole one
  };

  const std::size_t control_queue_count_;
  mutable std::mutex mutex_;
  std::deque<core::SharedBytes> control_;
  std::array<Slot, kMaxLayerCount> slots_;
  std::size_t turn_ = 0;          ///< the layer that is asked first
  std::uint64_t turn_count_ = 0;  ///< times the writer took something
  bool writer_sleeps_ = false;
  bool shut_ = false;
  std::optional<SessionEnd> close_;
};

}  // namespace spindrift::net
