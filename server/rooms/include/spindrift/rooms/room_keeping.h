// The state of a room on disk: what is written while it runs, and how it continues from there after a restart.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include <spindrift/core/result.h>
#include <spindrift/history/diary.h>
#include <spindrift/history/repetition.h>
#include <spindrift/history/state_store.h>
#include <spindrift/rooms/room_time.h>
#include <spindrift/rooms/roster.h>
#include <spindrift/v1/kept_state.pb.h>
#include <spindrift/water/room_water.h>
#include <spindrift/water/water_builder.h>

namespace spindrift::rooms {

class RoomKeeping {
 public:
  using TimePoint = RoomTime::TimePoint;

  /// The parts of the room that are kept; they outlive this.
  struct Parts {
    const std::string& room;
    v1::RoomAccess& access;
    water::RoomWater& water;
    RoomTime& time;
    Roster& roster;
    v1::Fidelity& chosen_fidelity;
    history::Diary& diary;
    water::WaterBuilder& builder;
    std::chrono::milliseconds disk_patience;  ///< RoomRules::disk_patience
  };
  explicit RoomKeeping(const Parts& parts) : parts_(parts) {}

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
  /// Returns the state between two ticks; nullopt when the device does not answer.
  std::optional<v1::KeptState> stateNow();
  void restorePeople(const history::KeptRoom& kept);
  [[nodiscard]] core::Error cannotBeWritten(const core::Error& why) const;

  /// Needs of a room that begins.
  struct Restoration {
    std::unique_ptr<history::StateKeeper> keeper;
    std::optional<history::RestoredRoom> room;
  };

  Parts parts_;
  std::optional<Restoration> restoration_;  ///< until the room is where it was
  TimePoint first_snapshot_until_{};
};

}  // namespace spindrift::rooms
