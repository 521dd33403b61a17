// The water of one room and what commands do to it: no clock, no people, no network. What a room runs live, `replay`
// runs again.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include <spindrift/core/command.h>
#include <spindrift/core/result.h>
#include <spindrift/sim/water_sim.h>
#include <spindrift/stream/client_message.h>
#include <spindrift/v1/scene.pb.h>

namespace spindrift::app {

/// A simulation whose shaders are compiled, put back to its start. Its ticks have begun to count; its boats' ids begin
/// at `first_boat_id`.
core::Result<std::unique_ptr<sim::WaterSim>> createWarm(gpu::Context& ctx, const v1::Scene& scene,
                                                        std::uint32_t first_boat_id = 1);

/// A rejection that the caller gives its command's number.
stream::CommandRejection rejection(v1::RejectReason reason, std::string field, std::string message);
/// Errors of several lines (one a field) in one.
std::string firstLine(const std::string& text);

/// Lives on the thread that owns the context.
class Stage {
 public:
  /// Empty: applied.
  using Outcome = std::optional<stream::CommandRejection>;

  /// `scene` is checked and has its defaults.
  static core::Result<std::unique_ptr<Stage>> create(gpu::Context& ctx, v1::Scene scene);

  /// Whether apply() takes the action: it touches the water. Time, scenes and who owns what are the room's business.
  static bool takes(const core::Action& action);
  /// Carries an action out now, between two ticks; a rejected one changes nothing.
  Outcome apply(const core::Action& action);
  /// Another scene from its start. The room's ticks go on: it begins at a tick that no frame of the old one has.
  Outcome replaceScene(v1::Scene scene);
  void step() {
    sim_->step();
    ++state_id_;
  }

  [[nodiscard]] const v1::Scene& scene() const { return scene_; }  ///< parameters as they are now
  [[nodiscard]] sim::WaterSim& water() { return *sim_; }
  [[nodiscard]] const sim::WaterSim& water() const { return *sim_; }
  /// Ticks since the room began, whatever its scenes: never goes back.
  [[nodiscard]] std::uint64_t tick() const { return tickOf(sim_->tick()); }
  /// The room's tick for one of the simulation's.
  [[nodiscard]] std::uint64_t tickOf(std::uint64_t sim_tick) const { return sim_tick + tick_shift_; }
  /// Number of the state now: another one after every tick and every change by apply() and replaceScene(). Never 0, and
  /// it never goes back.
  [[nodiscard]] std::uint64_t stateId() const { return state_id_; }
  /// Of the last SpawnBoat that was applied.
  [[nodiscard]] std::uint32_t spawnedBoatId() const { return spawned_boat_id_; }
  /// The boats on the water now.
  [[nodiscard]] v1::BoatList boats() const;

 private:
  Stage(gpu::Context& ctx, v1::Scene scene, std::unique_ptr<sim::WaterSim> sim);

  Outcome startEffect(const core::Effect& effect);
  Outcome setParameter(const core::SetParameter& change);
  Outcome spawnBoat(const core::SpawnBoat& spawn);
  Outcome controlBoat(const core::ControlBoat& control);
  Outcome removeBoat(const core::RemoveBoat& remove);

  gpu::Context& ctx_;
  v1::Scene scene_;
  std::unique_ptr<sim::WaterSim> sim_;
  std::uint64_t tick_shift_ = 0;  ///< from the simulation's ticks to the room's, modulo 2^64
  std::uint64_t state_id_ = 1;
  std::uint32_t spawned_boat_id_ = 0;
};

}  // namespace spindrift::app
