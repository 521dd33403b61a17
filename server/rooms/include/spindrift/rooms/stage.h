// The water of one room and what commands do to it: no clock, no people, no network. What a room runs live, `replay`
// runs again.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include <spindrift/core/command.h>
#include <spindrift/core/result.h>
#include <spindrift/rooms/tick_cost.h>
#include <spindrift/rooms/water.h>
#include <spindrift/sim/prepared_scene.h>
#include <spindrift/sim/water_sim.h>
#include <spindrift/v1/scene.pb.h>
#include <spindrift/wire/client_message.h>

namespace spindrift::rooms {

/// A rejection that the caller gives its command's number.
wire::CommandRejection rejection(v1::RejectReason reason, std::string field, std::string message);
/// Errors of several lines (one a field) in one.
std::string firstLine(const std::string& text);

/// Lives on the thread that has bound its water.
class Stage {
 public:
  /// Empty: applied.
  using Outcome = std::optional<wire::CommandRejection>;

  /// `water` is bound to the calling thread; its scene is checked and has its defaults.
  explicit Stage(std::unique_ptr<Water> water);

  /// Whether apply() takes the action: it touches the water. Time, scenes and who owns what are the room's business.
  static bool takes(const core::Action& action);
  /// Carries an action out now, between two ticks; a rejected one changes nothing.
  Outcome apply(const core::Action& action);

  /// A change of a parameter that lays the particles out anew, which takes long enough for a thread of its own.
  struct Relayout {
    core::SetParameter change;
    v1::Scene changed;
    core::Scene wanted;  ///< `changed` for sim::prepareScene()
    sim::SceneBasis basis;
  };
  /// Set where the action is such a change, with copies of what it starts from; else apply() carries it out or says why
  /// not. What apply() does in one call: sim::prepareScene() of `wanted` and `basis` on any thread, then adopt(), with
  /// no tick in between.
  [[nodiscard]] std::optional<Relayout> relayout(const core::Action& action);
  Outcome adopt(Relayout relayout, core::Result<sim::PreparedScene> prepared);
  /// The work of a tick, now or with another value of a parameter; nullopt where that is not allowed: apply() tells
  /// why.
  [[nodiscard]] TickWork work() const;
  [[nodiscard]] std::optional<TickWork> workWith(const core::SetParameter& change) const;
  /// What a tick took while the water was built [ms].
  [[nodiscard]] double warmTick_ms() const { return water_->warmTick_ms(); }
  /// Goes on with other water, which is bound from now on; returns the old one, still to be destroyed. The room's ticks
  /// go on: the new water begins at a tick that no frame of the old one has, and its boats get ids that none had.
  [[nodiscard]] std::unique_ptr<Water> replaceWater(std::unique_ptr<Water> water);
  /// Makes this stage's GL context current; call it before anything else when another one may be.
  void bind() { water_->bind(); }
  /// gpu::Context::reloadChangedShaders().
  void reloadChangedShaders() { water_->context().reloadChangedShaders(); }
  void step() {
    water().step();
    ++state_id_;
  }
  /// Water::failure().
  [[nodiscard]] std::optional<std::string> failure() { return water_->failure(); }

  [[nodiscard]] const v1::Scene& scene() const { return water_->scene(); }  ///< parameters as they are now
  [[nodiscard]] sim::WaterSim& water() { return water_->sim(); }
  [[nodiscard]] const sim::WaterSim& water() const { return water_->sim(); }
  [[nodiscard]] const gpu::DeviceInfo& device() const { return water_->context().device(); }
  /// Ticks since the room began, whatever its scenes: never goes back.
  [[nodiscard]] std::uint64_t tick() const { return tickOf(water().tick()); }
  /// The room's tick for one of the simulation's.
  [[nodiscard]] std::uint64_t tickOf(std::uint64_t sim_tick) const { return sim_tick + tick_shift_; }
  /// Number of the state now: another one after every tick and every change by apply() and replaceWater(). Never 0, and
  /// it never goes back.
  [[nodiscard]] std::uint64_t stateId() const { return state_id_; }
  /// Boat id of the last SpawnBoat that was applied.
  [[nodiscard]] std::uint32_t spawnedBoatId() const { return spawned_boat_id_; }
  /// The boats on the water now.
  [[nodiscard]] v1::BoatList boats() const;

 private:
  Outcome startEffect(const core::Effect& effect);
  Outcome setParameter(const core::SetParameter& change);
  Outcome spawnBoat(const core::SpawnBoat& spawn);
  Outcome controlBoat(const core::ControlBoat& control);
  Outcome removeBoat(const core::RemoveBoat& remove);

  std::unique_ptr<Water> water_;
  std::uint64_t tick_shift_ = 0;  ///< from the simulation's ticks to the room's, modulo 2^64
  std::uint64_t state_id_ = 1;
  std::uint32_t spawned_boat_id_ = 0;
};

}  // namespace spindrift::rooms
