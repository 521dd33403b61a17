// One room: a scene, its water, its clock, and the commands on their way to it. Lives on the simulation thread; the few
// functions that other threads may call say so.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <spindrift/core/bounded_queue.h>
#include <spindrift/core/command.h>
#include <spindrift/core/frame_view.h>
#include <spindrift/core/result.h>
#include <spindrift/net/server.h>
#include <spindrift/sim/water_sim.h>
#include <spindrift/stream/client_message.h>
#include <spindrift/v1/scene.pb.h>

#include "encoder_thread.h"
#include "real_time_clock.h"

namespace spindrift::app {

/// Name in the URL (letters, digits, '_', '-') and the checked scene with its defaults filled in.
struct RoomSetup {
  std::string name;
  v1::Scene scene;
};

/// What other threads may know of a room: immutable, replaced when it changes.
struct RoomSnapshot {
  v1::Scene scene;  ///< with parameters as they are now
  bool paused = false;
  double speed = 1.0;
};

class Room {
 public:
  using TimePoint = RealTimeClock::TimePoint;

  static core::Result<std::unique_ptr<Room>> create(gpu::Context& ctx, RoomSetup setup);

  // Any thread.
  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::shared_ptr<const RoomSnapshot> snapshot() const;
  /// False when the queue is full (BUSY); nothing is kept then.
  [[nodiscard]] bool submit(core::Command command) { return commands_.tryPush(std::move(command)); }

  // Simulation thread.
  void start(TimePoint now);
  /// When the room wants to run again.
  [[nodiscard]] TimePoint due(TimePoint now) const;
  /// Drains commands, steps if not paused, asks for a frame when one is due and watched, hands over finished ones.
  void run(TimePoint now, net::Hub& hub, EncoderThread& encoder);

  /// For the summary at the end.
  [[nodiscard]] const sim::WaterSim& water() const { return *sim_; }
  /// Ends the simulation while the context still lives; only the any-thread functions may be called afterwards.
  void releaseDevice() { sim_.reset(); }
  [[nodiscard]] double meanRealTimeFactor(TimePoint now) const;
  [[nodiscard]] std::uint64_t droppedFrameCount() const { return dropped_frames_; }

 private:
  Room(std::string name, v1::Scene scene, std::unique_ptr<sim::WaterSim> sim);

  void applyCommands(net::Hub& hub);
  /// Empty optional: applied.
  std::optional<stream::CommandRejection> apply(const core::Command& command, net::Hub& hub);
  std::optional<stream::CommandRejection> setParameter(const core::Command& command, const core::SetParameter& change,
                                                       net::Hub& hub);
  void requestFrame(TimePoint now, net::Hub& hub);
  void handOverFrames(EncoderThread& encoder);
  core::DiagnosticsView diagnostics();
  void watchRealTime(TimePoint now);
  void publishSnapshot();

  const std::string name_;
  v1::Scene scene_;
  std::unique_ptr<sim::WaterSim> sim_;
  core::BoundedQueue<core::Command> commands_;
  RealTimeClock clock_;
  bool paused_ = false;
  double next_frame_s_ = 0.0;    ///< simulation time
  TimePoint next_idle_frame_{};  ///< wall time, while paused
  bool wants_diagnostics_ = false;
  std::uint32_t frames_in_flight_ = 0;
  std::uint64_t dropped_frames_ = 0;

  double step_ms_sum_ = 0.0;  ///< since the last diagnostics
  std::uint32_t step_count_ = 0;
  double last_step_ms_ = 0.0;
  std::vector<core::DiagnosticsView::PassTime> last_passes_;
  double run_s_ = 0.0;  ///< simulated seconds since the start, resets not counted back
  double unpaused_wall_s_ = 0.0;
  TimePoint last_run_{};
  TimePoint slow_since_{};
  TimePoint next_slow_warning_{};

  mutable std::mutex snapshot_mutex_;
  std::shared_ptr<const RoomSnapshot> snapshot_;
};

}  // namespace spindrift::app
