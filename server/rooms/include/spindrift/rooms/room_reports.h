// What others know of a room: a snapshot for other threads, and the changes that its clients are told.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>

#include <spindrift/rooms/room_data.h>
#include <spindrift/rooms/room_view.h>
#include <spindrift/v1/wire.pb.h>

namespace spindrift::rooms {

/// Reports the growth of a counter at most once per interval; the next report includes all growth in between.
class GrowthNews {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  explicit GrowthNews(TimePoint::duration interval) : interval_(interval) {}

  /// Returns whether to report `count` now; if so, it counts as reported.
  [[nodiscard]] bool tell(std::uint64_t count, TimePoint now) {
    if (count == told_count_ || now < next_) return false;
    told_count_ = count;
    next_ = now + interval_;
    return true;
  }
  /// Sets a new starting value of the counter.
  void restart(std::uint64_t count) { told_count_ = count; }

 private:
  TimePoint::duration interval_;
  std::uint64_t told_count_ = 0;
  TimePoint next_{};
};

/// Lives on the simulation thread, except for snapshot() and lesson().
class RoomReports {
 public:
  using TimePoint = RoomTime::TimePoint;

  explicit RoomReports(RoomData& room) : room_(room) { begin(); }

  /// Any thread.
  [[nodiscard]] std::shared_ptr<const RoomSnapshot> snapshot() const { return snapshot_.get(); }
  [[nodiscard]] std::shared_ptr<const LessonState> lesson() const { return lesson_.get(); }

  /// Starts from the present water, of which nobody has to be told.
  void begin();
  /// Other water has replaced the present one: the clients get a greeting, which contains all.
  void sceneChanged();
  /// Tells the room's news.
  void tell();
  /// Tells who is in the room; `is_news`: that has changed.
  void tellPeople(bool is_news, TimePoint now);
  /// Tells how the game stands if that has changed, up to 5 times per second.
  void tellGame(TimePoint now);
  /// Tells where the fingers are, up to 30 times per second.
  void tellStrokes(TimePoint now);
  /// Tells that the watchdog has acted, from time to time. Returns whether it did.
  bool tellRecovery(TimePoint now);
  /// Returns when tellPeople() has something to tell; nullopt: nothing waits.
  [[nodiscard]] std::optional<TimePoint> due() const;

 private:
  void publishSnapshot();
  /// `person_id`: whose command changed it; 0: nobody's in the room.
  [[nodiscard]] v1::RoomState state(std::uint32_t person_id) const;
  /// Announces the boats on the water if they differ from the last announcement.
  void tellBoats();

  RoomData& room_;
  v1::BoatList boats_;  ///< as last announced
  GrowthNews recovery_news_{std::chrono::seconds(1)};
  bool has_people_news_ = false;
  TimePoint next_people_news_{};
  v1::Game game_;  ///< as last announced
  TimePoint next_game_news_{};
  bool has_told_strokes_ = false;
  TimePoint next_stroke_news_{};
  Published<RoomSnapshot> snapshot_;
  Published<LessonState> lesson_;
};

}  // namespace spindrift::rooms
