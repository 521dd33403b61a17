// The state of a room on disk: what is written while it runs, and how it continues from there after a restart.
#pragma once

#include <memory>
#include <optional>

#include <spindrift/core/result.h>
#include <spindrift/history/repetition.h>
#include <spindrift/history/state_store.h>
#include <spindrift/rooms/room_data.h>
#include <spindrift/v1/kept_state.pb.h>

namespace spindrift::rooms {

class RoomKeeping {
 public:
  using TimePoint = RoomTime::TimePoint;

  explicit RoomKeeping(RoomData& room) : room_(room) {}

  /// Keeps the room in `place` from restoreUntil() on. If a room is kept there, puts its snapshot into the water.
  /// Error: kInvalidInput if the room cannot continue from there.
  core::Result<void> begin(history::RoomPlace place);
  /// Room::restoreUntil(): afterwards water, time, people and access are those that were kept.
  core::Result<bool> restoreUntil(TimePoint deadline);
  /// Room::isOnDisk().
  core::Result<bool> isOnDisk(TimePoint deadline);

  /// Writes a snapshot when one is due, otherwise how far the room has come. Call it in each round of a room that runs.
  void keep(TimePoint now);
  /// Room::saveUntil(), in a room whose device works.
  core::Result<void> saveUntil(TimePoint deadline);

 private:
  /// Begins to write a snapshot. Error: the device does not answer.
  core::Result<void> save();
  /// Writes how far the room has come, unless it stands still.
  void writeProgress();
  /// Returns the state between two ticks; nullopt when the device does not answer.
  std::optional<v1::KeptState> stateNow();
  void restorePeople(const history::KeptRoom& kept);
  [[nodiscard]] core::Error cannotBeWritten(const core::Error& why) const;

  RoomData& room_;
  // Until the room is where it was:
  std::unique_ptr<history::StateKeeper> coming_keeper_;
  std::optional<history::RestoredRoom> restored_;

  TimePoint first_snapshot_until_{};
  TimePoint next_progress_{};
  std::uint64_t saved_state_id_ = 0;  ///< RoomWater::stateId() of the last snapshot
  std::uint64_t told_state_id_ = 0;   ///< and of the last writeProgress()
};

}  // namespace spindrift::rooms
