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
#include "growth_news.h"
#include "real_time_clock.h"
#include "scene_catalog.h"

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
  v1::BoatList boats;  ///< on the water now
};

class Room;

/// Who has to know that a room is another one now. Called on the simulation thread; must not block.
class RoomObserver {
 public:
  virtual ~RoomObserver() = default;
  /// The room's scene was replaced; its snapshot is the new one already.
  virtual void sceneChanged(const Room& room) = 0;
};

/// A simulation whose shaders are compiled, put back to its start. Its ticks have begun to count.
core::Result<std::unique_ptr<sim::WaterSim>> createWarm(gpu::Context& ctx, const v1::Scene& scene);

class Room {
 public:
  using TimePoint = RealTimeClock::TimePoint;

  /// The simulation is warm when this returns: every shader was compiled, and time stands at the start. `scenes` is
  /// what the room can be changed to; it and the context outlive the room.
  static core::Result<std::unique_ptr<Room>> create(gpu::Context& ctx, RoomSetup setup, const SceneCatalog& scenes);

  // Any thread.
  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::shared_ptr<const RoomSnapshot> snapshot() const;
  /// False when the queue is full (BUSY); nothing is kept then.
  [[nodiscard]] bool submit(core::Command command) { return commands_.tryPush(std::move(command)); }

  // Simulation thread.
  void start(TimePoint now);
  /// When the room wants to run again.
  [[nodiscard]] TimePoint due(TimePoint now) const;
  /// Drains commands, steps if not paused, asks for a frame when one is due and watched, hands over finished ones. At
  /// most one tick a call, so that rooms share the thread.
  void run(TimePoint now, net::Hub& hub, EncoderThread& encoder, RoomObserver& observer);

  /// For the summary at the end.
  [[nodiscard]] const sim::WaterSim& water() const { return *sim_; }
  /// Ticks since the room began, whatever its scenes: never goes back.
  [[nodiscard]] std::uint64_t tick() const { return sim_->tick() + tick_shift_; }
  /// Ends the simulation while the context still lives; only the any-thread functions may be called afterwards.
  void releaseDevice() { sim_.reset(); }
  [[nodiscard]] double meanRealTimeFactor(TimePoint now) const;
  [[nodiscard]] std::uint64_t droppedFrameCount() const { return dropped_frames_; }

 private:
  /// Empty: applied.
  using Outcome = std::optional<stream::CommandRejection>;

  Room(gpu::Context& ctx, std::string name, v1::Scene scene, const SceneCatalog& scenes,
       std::unique_ptr<sim::WaterSim> sim);

  void step(TimePoint now, net::Hub& hub);
  TimePoint timedStep();
  void advancePaused(TimePoint now, net::Hub& hub);

  // room_commands.cpp
  void applyCommands(net::Hub& hub, RoomObserver& observer);
  Outcome apply(const core::Command& command, net::Hub& hub, RoomObserver& observer);
  Outcome applyEffect(const core::Effect& effect);
  Outcome setParameter(const core::SetParameter& change, net::Hub& hub);
  Outcome reset(net::Hub& hub);
  Outcome spawnBoat(const core::SpawnBoat& spawn, net::Hub& hub);
  Outcome controlBoat(const core::ControlBoat& control);
  Outcome removeBoat(const core::RemoveBoat& remove, net::Hub& hub);
  Outcome advance(const core::Step& step);
  Outcome changeScene(const core::ChangeScene& change, RoomObserver& observer);
  void announceState(net::Hub& hub);
  /// Where the boats on the water are others than those announced last.
  void announceBoats(net::Hub& hub);
  void announceRecovery(TimePoint now, net::Hub& hub);

  void requestFrame(TimePoint now, net::Hub& hub);
  void readBoats();
  void handOverFrames(EncoderThread& encoder);
  core::DiagnosticsView diagnostics();
  void watchRealTime(TimePoint now);
  void publishSnapshot();

  gpu::Context& ctx_;
  const std::string name_;
  const SceneCatalog& scenes_;
  v1::Scene scene_;
  std::unique_ptr<sim::WaterSim> sim_;
  core::BoundedQueue<core::Command> commands_;
  RealTimeClock clock_;
  std::uint64_t tick_shift_ = 0;  ///< from the simulation's ticks to the room's, modulo 2^64
  bool paused_ = false;
  std::uint32_t pending_tick_count_ = 0;  ///< of Step: ticks that the paused room still advances
  v1::BoatList boats_;                    ///< as announced last
  std::uint32_t spawned_boat_id_ = 0;     ///< of the command being applied
  GrowthNews recovery_news_{std::chrono::seconds(1)};
  TimePoint next_scene_change_{};
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
