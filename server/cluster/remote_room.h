// A room that runs on another server, as the sessions of this process see it: keeps a link to it, passes its frames and
// messages on, and looks for it when it falls silent.
#pragma once

#include <array>
#include <chrono>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <spindrift/bus/bus.h>
#include <spindrift/codec/stream.h>
#include <spindrift/service/sessions.h>
#include <spindrift/service/venue.h>
#include <spindrift/v1/cluster.pb.h>

#include "frame_head.h"
#include "kept_frame.h"
#include "subjects.h"

namespace spindrift::cluster {

/// People that a room lists. Beyond it, those who only watch are counted by their node, and the room need not know
/// them.
inline constexpr int kListedPeopleMaxCount = 64;

/// Streams whose frames come less often are kept whole for late sessions, at the cost of decoding each frame: in paused
/// rooms and on machines that cannot keep up. Where frames come more often, the next one is near.
inline constexpr std::chrono::milliseconds kRareFrameInterval{100};

struct LinkStats {
  std::uint64_t frame_count = 0;
  std::uint64_t gap_count = 0;  ///< frames or messages that did not come
  std::uint64_t lost_link_count = 0;

  void add(const LinkStats& other) {
    frame_count += other.frame_count;
    gap_count += other.gap_count;
    lost_link_count += other.lost_link_count;
  }
};

/// Thread-safe. Frames and messages come on the thread of the bus.
class RemoteRoom final : public service::Venue {
 public:
  using Clock = std::chrono::steady_clock;

  /// `bus`, `subjects` and `sessions` outlive it. `node`: the name of this process.
  RemoteRoom(std::string name, std::string node, bus::Bus& bus, const Subjects& subjects, service::Sessions& sessions);

  /// Sends what is due, and attaches again where the link is lost. Call it some twenty times per second.
  void review(Clock::time_point now);
  /// A message of the room.
  void take(const v1::FromRoom& message);
  /// Nobody needs the link: tells the room.
  void detach();
  /// True if no session was here for a while.
  [[nodiscard]] bool isIdle(Clock::time_point now) const;
  [[nodiscard]] LinkStats stats() const;

  // Venue
  [[nodiscard]] const std::string& name() const override { return name_; }
  [[nodiscard]] std::shared_ptr<const service::VenueView> view() const override;
  [[nodiscard]] v1::People people() const override;
  [[nodiscard]] std::shared_ptr<const rooms::LessonState> lesson() const override;
  [[nodiscard]] std::shared_ptr<core::DemandTable> demand() const override { return demand_; }
  [[nodiscard]] bool isOpen() const override;
  void arrive(const rooms::Arrival& arrival, Arrived arrived) override;
  void leave(core::SessionId session) override;
  void watchesChanged() override;
  void command(const rooms::Command& command) override;

 private:
  struct Guest {
    rooms::Arrival arrival;
    Arrived arrived;  ///< empty once called
    Clock::time_point since{};
    bool is_listed = true;
    std::deque<std::uint64_t> commands{};  ///< unanswered ones
  };
  /// One stream at one level, as it comes over the bus.
  struct Feed {
    std::unique_ptr<bus::Subscription> frames;
    std::unique_ptr<bus::Subscription> keyframes;  ///< while somebody needs one
    Clock::time_point keyframe_wanted{};
    std::uint64_t run = 0;
    std::uint64_t sequence = 0;
    std::uint32_t reduced_count = 0;  ///< of the newest frame
    bool is_whole = false;            ///< the frame before came: deltas can be used
    bool asked = false;               ///< a keyframe
    Clock::time_point came{};
    Clock::duration interval{};  ///< smoothed
    KeptFrame kept{};            ///< the newest frame, or nothing

    [[nodiscard]] bool isRare() const { return interval > kRareFrameInterval; }
    /// A late session would have to wait: a keyframe is wanted, from which on the frames can be kept.
    [[nodiscard]] bool lacksKept() const { return isRare() && !kept.isWhole(); }
  };
  using Dropped = std::vector<std::unique_ptr<bus::Subscription>>;

  /// Returns what the answer to a command needs of it.
  static rooms::Command commandOf(core::SessionId session, std::uint64_t id);
  void attach(Clock::time_point now);
  void send(v1::ToRoom message);
  void sendArrival(const Guest& guest);
  /// The link is gone; returns the commands that nobody will answer.
  std::vector<rooms::Command> loseLink();
  void reject(const std::vector<rooms::Command>& commands, const std::string& why);
  void takeView(const v1::RoomView& message);
  void takeNews(const v1::RoomNews& message);
  void takeAdmission(const v1::Admitted& message);
  void takeOutcome(const v1::Outcome& message);
  void takeClosed();
  void takeFrame(std::size_t stream, core::Level level, core::ByteView message);
  /// Gives the newest frames to sessions that have had none.
  void offerKept();
  /// Compares what the sessions watch with what comes, and tells the room if `must_tell` or something changed. What is
  /// no longer needed goes to `dropped`, to be destroyed without the lock.
  void reviewStreams(Clock::time_point now, bool must_tell, Dropped& dropped);
  /// Returns the expected time from now to the next frame of the stream.
  [[nodiscard]] Clock::duration aheadOf(std::size_t stream) const;
  [[nodiscard]] Feed& feed(std::size_t stream, core::Level level) { return feeds_[stream][core::indexOf(level)]; }

  const std::string name_;
  const std::string node_;
  bus::Bus& bus_;
  const Subjects& subjects_;
  service::Sessions& sessions_;
  const std::shared_ptr<core::DemandTable> demand_ = std::make_shared<core::DemandTable>();
  /// Held from the choice of a frame until it is in the outboxes, so that sessions get frames in their order. Lock it
  /// before mutex_.
  std::mutex frames_mutex_;
  mutable std::mutex mutex_;
  std::uint64_t link_ = 0;      ///< number of the present or attempted link
  std::uint64_t sequence_ = 0;  ///< of the last message on it
  bool attached_ = false;
  bool closed_ = false;
  Clock::time_point heard_{};
  Clock::time_point tried_{};
  Clock::time_point told_{};
  std::optional<Clock::time_point> lost_since_;
  Clock::time_point used_;
  std::shared_ptr<const service::VenueView> view_;
  v1::People people_;
  std::shared_ptr<const rooms::LessonState> lesson_ = std::make_shared<const rooms::LessonState>();
  std::optional<std::array<std::uint32_t, codec::kStreamCount>> reduced_counts_;
  std::map<core::SessionId, Guest> guests_;
  std::uint32_t last_unlisted_ = 0;
  std::array<std::array<Feed, core::kLevelCount>, codec::kStreamCount> feeds_;
  std::array<core::LevelSet, codec::kStreamCount> told_levels_;  ///< that sessions ask for, as the room knows it
  LinkStats stats_;
};

}  // namespace spindrift::cluster
