// What other threads see of a room: immutable values, replaced when they change.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include <spindrift/core/frame_view.h>
#include <spindrift/core/result.h>
#include <spindrift/rooms/placed_gauge.h>
#include <spindrift/rooms/tick_meter.h>
#include <spindrift/sim/water_sim.h>
#include <spindrift/v1/scene.pb.h>
#include <spindrift/v1/wire.pb.h>

namespace spindrift::rooms {

/// State of a room.
struct RoomSnapshot {
  v1::Scene scene;                  ///< with current parameter values
  std::uint64_t scene_version = 0;  ///< RoomWater::sceneVersion()
  bool paused = false;
  double speed = 1.0;
  std::vector<std::uint32_t> clock_person_ids;      ///< who holds the clock, ascending
  v1::BoatList boats;                               ///< boats on the water now
  core::ReducedCounts reduced_counts;               ///< levels that downsample the frames
  std::shared_ptr<const sim::GaugeHistory> gauges;  ///< null in scenes without gauges
  std::vector<PlacedGauge> placed_gauges;           ///< that people have placed, oldest first
};

/// The rules for players in a room, and its game.
struct LessonState {
  v1::Lesson lesson;
  v1::Game game;
};

/// sim::WaterSim::stateHash() after a tick of the room.
struct HashedState {
  std::uint64_t tick = 0;
  std::uint64_t hash = 0;
};
using HashDone = std::function<void(const core::Result<HashedState>&)>;

/// Condition of a room, for /metrics and lists; updated a few times per second.
struct RoomVitals {
  std::uint64_t tick = 0;
  double time_s = 0.0;
  bool asleep = false;
  bool lost = false;  ///< the device failed; new water is being built
  std::uint32_t waiting_command_count = 0;
  std::uint64_t device_bytes = 0;  ///< buffers of its water
  std::uint64_t dropped_frame_count = 0;
  TickTimes tick_times;  ///< since the room opened
  core::DiagnosticsView diagnostics;
  v1::FidelityLevels fidelity_levels;  ///< of the scene, with costs as of the last ticks
};

/// A value that one thread replaces and any thread reads.
template <typename T>
class Published {
 public:
  void publish(T value) {
    auto fresh = std::make_shared<const T>(std::move(value));
    const std::lock_guard lock(mutex_);
    value_ = std::move(fresh);
  }
  /// Null before the first publish().
  [[nodiscard]] std::shared_ptr<const T> get() const {
    const std::lock_guard lock(mutex_);
    return value_;
  }

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<const T> value_;
};

}  // namespace spindrift::rooms
