// Brings the water of a room from a snapshot to where it was, by repeating what its log on disk holds after the
// snapshot.
#pragma once

#include <chrono>
#include <cstdint>
#include <future>

#include <spindrift/core/result.h>
#include <spindrift/rooms/room_time.h>
#include <spindrift/rooms/room_water.h>
#include <spindrift/rooms/state_keeper.h>
#include <spindrift/rooms/water_builder.h>
#include <spindrift/v1/scene.pb.h>
#include <spindrift/v1/wire.pb.h>

namespace spindrift::rooms {

class Repetition {
 public:
  using TimePoint = RoomTime::TimePoint;

  /// The parts of the room that it moves; they outlive it.
  struct Parts {
    RoomWater& water;
    RoomTime& time;
    v1::Fidelity& chosen_fidelity;
    WaterBuilder& builder;  ///< makes the water of scene changes
  };
  /// Puts the snapshot into the parts. After an error the water may have any state.
  static core::Result<Repetition> begin(KeptRoom kept, Parts parts);
  /// Repeats at least a tick, and then until the deadline; with TimePoint::max() to the end. Returns whether the water
  /// is where it was. Errors: those of RoomWater and of the builder; the water may have any state then.
  core::Result<bool> continueUntil(TimePoint deadline);
  [[nodiscard]] const KeptRoom& kept() const { return kept_; }

 private:
  Repetition(KeptRoom kept, Parts parts) : parts_(parts), kept_(std::move(kept)) {}
  /// A tick, or what the next record says. Returns false if it has to wait for new water and `waits` is not set.
  core::Result<bool> repeatNext(bool waits);
  /// Returns false if it has to wait, as above.
  core::Result<bool> changeWater(const v1::StateRecord& record, bool waits);
  void repeat(const v1::Command& message);

  Parts parts_;
  KeptRoom kept_;
  std::size_t next_ = 0;           ///< of the records
  std::uint64_t steps_until_ = 0;  ///< the tick up to which Step commands lead
  std::future<WaterBuilder::Built> next_water_{};
};

}  // namespace spindrift::rooms
