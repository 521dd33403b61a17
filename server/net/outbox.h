// The messages that wait to be sent to one session. Producers on any thread put messages in; the session's writer takes
// them out one at a time. Bounded by construction: `answer_max_count` answers, one message per state topic and one
// frame per stream, whatever this or any other client does. No task is queued per frame.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include <spindrift/core/bytes.h>
#include <spindrift/core/demand_table.h>
#include <spindrift/net/server.h>

#include "level_ladder.h"
#include "rate_limit.h"

namespace spindrift::net {

/// Thread-safe. Two planes; control goes first. Answers are ordered and never dropped. Of a state topic only the newest
/// message waits, in the place of the older one, so that a client never reads an answer before a state that is at least
/// as new. Data: the newest frame per stream, streams in turn. A waiting frame is sent after at most
/// kControlRunMaxCount control messages.
class Outbox {
 public:
  explicit Outbox(std::size_t answer_max_count) : answer_max_count_(answer_max_count) {}
  ~Outbox() { enterRoom(nullptr); }
  Outbox(const Outbox&) = delete;
  Outbox& operator=(const Outbox&) = delete;

  /// Most control messages in a row while a frame waits.
  static constexpr std::size_t kControlRunMaxCount = 8;

  /// Result of a call: its effects, and the work that is left to the caller.
  struct Outcome {
    bool wake = false;      ///< the writer sleeps: wake it
    bool dropped = false;   ///< an unsent older frame was replaced
    bool overflow = false;  ///< too many answers waited: this call requested a close with kTryAgainLater
  };

  /// Appends an answer. If `answer_max_count` answers already wait, it is dropped and the session is closed with
  /// kTryAgainLater after the queued messages. Ignored after a close was requested.
  Outcome pushAnswer(core::SharedBytes message);

  /// Puts the state in the place of the oldest waiting message that it replaces, otherwise at the end. It replaces
  /// messages of the same topic; Scope::kWhole also replaces all with Scope::kPart. Ignored after a close was
  /// requested.
  Outcome pushState(const StateTopic& topic, core::SharedBytes message);

  /// Puts the frame into its stream's slot if the session's level takes it and the rate of the watch allows: the delta
  /// if the client has the frame that it builds on, otherwise the keyframe. Without a keyframe an unsent older frame is
  /// dropped, and the session waits. Ignored after a close was requested. Wakes nobody: call wakeForFrames() after the
  /// last frame of a moment.
  Outcome offerFrame(StreamIndex stream, const FrameBytes& frame, Clock::time_point now);

  /// Puts the newest frame of a stream, a keyframe that other sessions have had already, into the slot of a session
  /// that has just begun to watch it: Watch::is_first, and no frame has come since. The next frame may follow at once,
  /// whatever the rate. Ignored after a close was requested.
  Outcome offerNewest(StreamIndex stream, const FrameBytes& frame);

  /// Returns whether frames wait and the writer sleeps: wake it.
  bool wakeForFrames();

  /// The session is in a room from now on, and `demand` says what it needs of its frames, as long as it is there; null:
  /// it is in none, and unsent frames are dropped.
  void enterRoom(std::shared_ptr<core::DemandTable> demand);
  /// Returns what the session needs of the next frame of a stream; nullopt if it does not watch it. A session that has
  /// read nothing since it lost a frame needs no keyframe: none is made for a client that cannot take it. is_newcomer:
  /// offerNewest() would be taken.
  [[nodiscard]] std::optional<core::DemandTable::Need> need(StreamIndex stream) const;

  /// Starts, changes or stops (nullopt) a stream, and drops its unsent frame.
  void setWatch(StreamIndex stream, const std::optional<Watch>& watch);

  /// Evaluates from time to time how many frames of adapting watches were lost; returns the new level if it changed.
  /// The writer calls it after each sent message.
  std::optional<core::Level> reviewLevel(Clock::time_point now);

  /// Requests a close after the queued control messages; unsent frames are dropped. Returns true for the first request,
  /// which alone counts.
  bool requestClose(CloseCode code, std::string reason);

  /// The connection is gone: next() returns kShut from now on.
  void shut();

  enum class Kind { kIdle, kControl, kFrame, kClose, kShut };
  struct Next {
    Kind kind = Kind::kIdle;
    core::SharedBytes message;  ///< for kControl and kFrame
  };

  /// Returns the next thing to do. After kIdle the writer sleeps, and the next producer gets `wake`.
  Next next();

  /// For a message that is written together with the one that next() returned. Returns what next() would return if
  /// that is a message of at most `max_bytes`; nullopt otherwise, and then nothing has changed.
  std::optional<Next> nextAlong(std::size_t max_bytes);

  Waiting waiting() const;

  bool closing() const;
  /// Code and line of the first requestClose(); nullopt before it.
  std::optional<SessionEnd> closeRequest() const;

 private:
  struct Slot;
  /// Call with the mutex held. Returns true once after the writer went to sleep.
  bool takeWake();
  void beginClose(CloseCode code, std::string reason);
  /// Returns the level of the slot's watch as of now; the slot must have a watch.
  core::Level levelOf(const Slot& slot) const;
  Outcome put(StreamIndex stream, const FrameBytes& frame, Clock::time_point now);
  Outcome putNewest(StreamIndex stream, const FrameBytes& frame);
  /// Puts a message of the frame into the stream's slot.
  void fill(StreamIndex stream, const FrameBytes& frame, const core::SharedBytes& message);
  [[nodiscard]] std::optional<core::DemandTable::Need> needOf(const Slot& slot) const;
  /// Tells the room what it needs of the stream, if that has changed; or of all streams.
  void tellNeed(std::size_t stream);
  void tellNeeds();

  struct Slot {
    std::optional<Watch> watch;  ///< empty = not watched
    RateGate gate;
    core::SharedBytes frame;
    core::Level level = core::Level::kFull;  ///< of the newest frame taken
    std::uint32_t reduced_count = 0;         ///< of the newest frame
    bool is_newcomer = false;                ///< Watch::is_first, and no frame has been taken yet
    bool follows = false;                    ///< the client has the last frame, or gets it with `frame`
    std::optional<std::uint64_t> lost_turn;  ///< turn_count_ when a frame was lost because there was no keyframe
  };

  struct Control {
    core::SharedBytes message;
    std::optional<StateTopic> topic;  ///< nullopt: an answer
  };
  /// Call these with the mutex held.
  [[nodiscard]] bool isFrameBeforeControl() const;
  /// The stream whose frame is next; nullopt if none waits.
  [[nodiscard]] std::optional<std::size_t> nextStream();
  Next takeFrame(std::size_t stream);
  Next takeControl();

  /// A bit per stream.
  using StreamBits = std::uint16_t;
  static_assert(std::numeric_limits<StreamBits>::digits == kMaxStreamCount);

  const std::size_t answer_max_count_;
  // First what is looked at for each frame: much of the cost of a frame is memory that no cache has.
  mutable std::mutex mutex_;
  StreamBits filled_slots_ = 0;  ///< that got a frame since they were last found empty
  bool has_lost_turns_ = false;  ///< a slot got a lost_turn since the last next()
  bool writer_sleeps_ = false;
  bool shut_ = false;
  std::size_t turn_ = 0;                       ///< the stream that is checked first
  std::uint64_t turn_count_ = 0;               ///< number of times that the writer had finished what it took before
  std::shared_ptr<core::DemandTable> demand_;  ///< of the room; null outside of one
  std::optional<SessionEnd> close_;
  LevelLadder ladder_;
  std::deque<Control> control_;
  std::size_t answer_count_ = 0;       ///< answers in control_
  bool whole_state_waits_ = false;     ///< control_ holds a message with Scope::kWhole
  std::size_t control_run_count_ = 0;  ///< control messages taken since the last frame
  std::array<Slot, kMaxStreamCount> slots_;
  std::array<std::optional<core::DemandTable::Need>, kMaxStreamCount> told_needs_;
};

}  // namespace spindrift::net
