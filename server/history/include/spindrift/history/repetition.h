// Repeats what the log of a room holds, record by record.
#pragma once

#include <chrono>
#include <cstdint>
#include <future>

#include <spindrift/core/result.h>
#include <spindrift/history/state_keeper.h>
#include <spindrift/v1/record.pb.h>
#include <spindrift/v1/scene.pb.h>
#include <spindrift/v1/wire.pb.h>
#include <spindrift/water/room_water.h>
#include <spindrift/water/water_builder.h>

namespace spindrift::history {

/// State of a room beside its water, as its log gives it.
struct RepeatedRoom {
  double speed = 0.0;  ///< simulated seconds per wall second; 0: the usual one
  bool is_paused = false;
  std::uint32_t pending_tick_count = 0;  ///< ticks of Step commands that the paused room has still to advance
  v1::Fidelity chosen_fidelity = v1::FIDELITY_UNSPECIFIED;  ///< adapting never goes above it
};

/// After an error the water may have any state.
class Repetition {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  /// Starts from the present water. `builder` makes that of scene changes. Both outlive it.
  Repetition(water::RoomWater& water, water::WaterBuilder& builder) : water_(water), builder_(builder) {}
  /// Puts the state into the water. Error: RoomWater::restore().
  core::Result<void> restore(const v1::KeptState& state);

  enum class Wait { kNo, kForNewWater };
  /// Makes one tick, or does what the record says if its tick has come. Returns whether the record is done; false also
  /// if new water is needed, is not there yet, and `wait` says not to wait for it. Errors: those of the device and of
  /// the builder.
  core::Result<bool> advance(const v1::Record& record, Wait wait);
  /// Returns the rest of the room after the last record.
  [[nodiscard]] RepeatedRoom room() const;
  /// Returns the number of commands that changed the water.
  [[nodiscard]] std::uint64_t commandCount() const { return command_count_; }

 private:
  /// Returns false if it has to wait, as above.
  core::Result<bool> changeWater(const v1::Record& record, Wait wait);
  void repeat(const v1::Command& message);

  water::RoomWater& water_;
  water::WaterBuilder& builder_;
  RepeatedRoom room_;              ///< without its pending ticks
  std::uint64_t steps_until_ = 0;  ///< the tick up to which Step commands lead
  std::uint64_t command_count_ = 0;
  std::future<water::WaterBuilder::Built> next_water_{};
};

/// Brings a room from a snapshot to where it was.
class RestoredRoom {
 public:
  using TimePoint = Repetition::TimePoint;

  /// Puts the snapshot into the water. Errors: those of Repetition.
  static core::Result<RestoredRoom> begin(KeptRoom kept, water::RoomWater& water, water::WaterBuilder& builder);
  /// Repeats at least a tick or a record of the log, and then until the deadline; with TimePoint::max() to the end.
  /// Returns whether the room is where it was. Errors: those of Repetition.
  core::Result<bool> continueUntil(TimePoint deadline);
  [[nodiscard]] const KeptRoom& kept() const { return kept_; }
  /// Repetition::room().
  [[nodiscard]] RepeatedRoom room() const { return repetition_.room(); }

 private:
  RestoredRoom(KeptRoom kept, Repetition repetition) : kept_(std::move(kept)), repetition_(std::move(repetition)) {}

  KeptRoom kept_;
  Repetition repetition_;
  std::size_t next_ = 0;  ///< of the records
};

}  // namespace spindrift::history
