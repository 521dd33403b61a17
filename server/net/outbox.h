// What waits to be sent to one session. Producers on any thread put messages in, the session's writer takes them out
// one at a time. Bounded by construction: `answer_max_count` answers, one message per state topic and one frame per
// layer, whatever this client or another one does, and without a task queued per frame.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string>

#include <spindrift/core/bytes.h>
#include <spindrift/net/server.h>

#include "level_ladder.h"
#include "rate_limit.h"

namespace spindrift::net {

/// Thread-safe. Two planes. Control goes first: answers are ordered and never dropped; state is coalesced by topic, and
/// the newest message of a topic takes the place of the one that waits, so that a client never reads an answer before a
/// state that is at least as new. Data: the newest frame per layer, layers in turn; a waiting frame goes out at the
/// latest after kControlRunMaxCount control messages.
class Outbox {
 public:
  explicit Outbox(std::size_t answer_max_count) : answer_max_count_(answer_max_count) {}

  /// Control messages in a row while a frame waits.
  static constexpr std::size_t kControlRunMaxCount = 8;

  /// What a producer has to do after a call.
  struct Outcome {
    bool wake = false;      ///< the writer sleeps: wake it
    bool dropped = false;   ///< an unsent older frame was replaced
    bool overflow = false;  ///< too many answers waited: this call has asked for kTryAgainLater
  };

  /// Appends an answer. One that finds `answer_max_count` waiting is lost, and the session with it: a close with
  /// kTryAgainLater follows what is queued. Ignored once a close was asked for.
  Outcome pushAnswer(core::SharedBytes message);

  /// Puts the state where the oldest waiting message is that it replaces, or at the end. Replaced are messages of the
  /// same topic, by a topic with Scope::kWhole also all with Scope::kPart. Ignored once a close was asked for.
  Outcome pushState(const StateTopic& topic, core::SharedBytes message);

  /// Puts the frame into its layer's slot if the session watches the layer and its rate allows: the delta if the
  /// client has the frame that it builds on, else the keyframe. Without a keyframe an unsent older frame is dropped and
  /// the session waits. Frames of another level than the session's are not for it. Ignored once a close was asked for.
  Outcome offerFrame(LayerIndex layer, const LayerBytes& frame, Clock::time_point now);

  /// What the session would take next of a layer that it watches.
  struct Demand {
    core::Level level = core::Level::kFull;
    /// Only a keyframe helps. False for a session that has read nothing since it lost one: what it cannot take is not
    /// made for it.
    bool wants_keyframe = false;
  };
  Demand demand(LayerIndex layer, std::uint32_t reduced_count, Clock::time_point now) const;

  /// Starts a layer anew or stops it (nullopt), and forgets its unsent frame.
  void setWatch(LayerIndex layer, const std::optional<Watch>& watch);

  /// Judges how the link does with what adapts, from time to time; the new level if it changed. For the writer, after
  /// each message that went out.
  std::optional<core::Level> reviewLevel(Clock::time_point now);
  /// As judged last: what adapts gets at most this.
  core::Level level() const;

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
    std::size_t answer_count = 0;
    std::size_t state_count = 0;
    std::size_t frame_count = 0;
  };
  Waiting waiting() const;

  bool closing() const;
  /// Code and line of the first requestClose(); nullopt before.
  std::optional<SessionEnd> closeRequest() const;

 private:
  struct Slot;
  /// With the mutex held: true once after the writer said it sleeps.
  bool takeWake();
  /// What the slot's watch may have now; it has one.
  core::Level levelOf(const Slot& slot) const;
  /// Whether the watch's rate, and that of a reduced level which comes as kFull, let the next frame through.
  static bool isOpen(const Slot& slot, core::Level wanted, core::Level effective, Clock::time_point now);

  struct Slot {
    std::optional<Watch> watch;  ///< empty = not watched
    RateGate gate;
    /// Frames of reduced levels are made at their rate; where a reduced level leaves nothing out, this holds it.
    std::array<RateGate, core::kReducedLevelCount> level_gates;
    core::SharedBytes frame;
    core::Level level = core::Level::kFull;  ///< of the newest frame that was taken
    std::uint32_t reduced_count = 0;         ///< as the newest frame said
    bool follows = false;                    ///< the client has the last frame, or will have it with `frame`
    std::optional<std::uint64_t> lost_turn;  ///< turn_count_ when a frame was lost for want of a keyframe
  };

  struct Control {
    core::SharedBytes message;
    std::optional<StateTopic> topic;  ///< empty: an answer
  };
  /// The frame of the layer whose turn it is; null if none waits.
  core::SharedBytes takeFrame();

  const std::size_t answer_max_count_;
  mutable std::mutex mutex_;
  std::deque<Control> control_;
  std::size_t answer_count_ = 0;       ///< in control_
  bool whole_state_waits_ = false;     ///< in control_: a message with Scope::kWhole
  std::size_t control_run_count_ = 0;  ///< control messages taken since the last frame
  std::array<Slot, kMaxLayerCount> slots_;
  LevelLadder ladder_;
  std::size_t turn_ = 0;          ///< the layer that is asked first
  std::uint64_t turn_count_ = 0;  ///< times the writer took something
  bool writer_sleeps_ = false;
  bool shut_ = false;
  std::optional<SessionEnd> close_;
};

}  // namespace spindrift::net
