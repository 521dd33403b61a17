// The water of one room and the effect of commands on it, without clock, people and network. Used by live rooms and by
// `replay`.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <set>

#include <spindrift/core/result.h>
#include <spindrift/core/scene.h>
#include <spindrift/sim/prepared_scene.h>
#include <spindrift/sim/water_sim.h>
#include <spindrift/v1/kept_state.pb.h>
#include <spindrift/v1/scene.pb.h>
#include <spindrift/water/tick_cost.h>
#include <spindrift/water/water.h>
#include <spindrift/wire/client_message.h>

namespace spindrift::water {

/// Lives on the thread that has bound its water.
class RoomWater {
 public:
  /// nullopt: applied.
  using Outcome = std::optional<wire::CommandRejection>;

  /// `water` is bound to the calling thread; its scene is checked and has its defaults.
  explicit RoomWater(std::unique_ptr<Water> water);

  /// Returns whether the command changes the water and belongs to apply(). The room handles time, scenes and ownership.
  static bool takes(const v1::Command& command);
  /// Fills in what a command leaves to the present water: the side of a wave. Logs then hold the value that was in
  /// force.
  void fillIn(v1::Command& command) const;
  /// Applies a command that wire::completeCommand() accepted, between two ticks; a rejected one changes nothing.
  Outcome apply(const v1::Command& command);

  /// A parameter change that lays out the particles anew, which is slow enough to need another thread.
  struct Relayout {
    v1::SetParameter change;
    v1::Scene changed;
    core::Scene wanted;  ///< input of sim::prepareScene(), from `changed`
    sim::SceneBasis basis;
  };
  /// Returns such a change with copies of its inputs; nullopt if apply() handles the value. Then run
  /// sim::prepareScene() with `wanted` and `basis` on any thread and call adopt(), with no tick in between. apply()
  /// does the same in one call.
  [[nodiscard]] std::optional<Relayout> relayout(const v1::SetParameter& change);
  Outcome adopt(Relayout relayout, core::Result<sim::PreparedScene> prepared);
  /// Returns the work per tick, now or with another value of a parameter; nullopt if the value is not allowed, for
  /// which apply() gives the reason.
  [[nodiscard]] TickWork work() const;
  [[nodiscard]] std::optional<TickWork> workWith(const v1::SetParameter& change) const;
  /// Duration of a tick measured when the water was built [ms].
  [[nodiscard]] double warmTick_ms() const { return water_->warmTick_ms(); }
  /// Returns the size of its buffers.
  [[nodiscard]] std::uint64_t deviceBytes() const { return water_->context().ledger().buffer_bytes; }
  /// Water::levelCosts().
  [[nodiscard]] const LevelCosts& levelCosts() const { return water_->levelCosts(); }
  /// Replaces the water by another one, which is bound from now on; returns the old one for destruction. The room's
  /// tick continues: the new water starts at a tick later than any frame of the old one, and its boats get unused ids.
  [[nodiscard]] std::unique_ptr<Water> replaceWater(std::unique_ptr<Water> water);
  /// Continues with the present state in `next`, which is bound from now on: the same scene at another resolution,
  /// whose live parameters take their present values. Then `next` is the old water, for destruction. Room ticks
  /// continue as with replaceWater(). Errors leave both as they were: kUnavailable when the device failed,
  /// kInvalidInput when it is not the same water or a parameter changed meanwhile to what it cannot take.
  core::Result<void> continueIn(std::unique_ptr<Water>& next);
  /// Writes tick, scenes, water and its hash. Waits for the device.
  void save(v1::KeptState& state);
  /// Continues from there; the water was built from `state.start_scene()`. kInvalidInput if it does not fit: then the
  /// water may have any state.
  core::Result<void> restore(const v1::KeptState& state);
  /// Numbers the next ticks from after `tick` on, if they would come before it.
  void goOnAfter(std::uint64_t tick) {
    if (this->tick() <= tick) tick_shift_ += tick + 1 - this->tick();
  }
  /// Makes its GL context current. Call it first whenever another context may be current.
  void bind() { water_->bind(); }
  void release() { water_->release(); }
  /// gpu::Context::reloadChangedShaders().
  void reloadChangedShaders() { water_->context().reloadChangedShaders(); }
  void step() {
    sim().step();
    ++state_id_;
  }
  /// sim::WaterSim::takeHealth().
  void takeHealth();
  /// Water::failure().
  [[nodiscard]] std::optional<std::string> failure() { return water_->failure(); }

  [[nodiscard]] const v1::Scene& scene() const { return water_->scene(); }  ///< with current parameter values
  /// Grows with every change of scene(). Never 0.
  [[nodiscard]] std::uint64_t sceneVersion() const { return scene_version_; }
  [[nodiscard]] sim::WaterSim& sim() { return water_->sim(); }
  [[nodiscard]] const sim::WaterSim& sim() const { return water_->sim(); }
  [[nodiscard]] const gpu::DeviceInfo& device() const { return water_->context().device(); }
  /// Ticks since the room started, across scene changes: never decreases.
  [[nodiscard]] std::uint64_t tick() const { return tickOf(sim().tick()); }
  /// Converts a tick of the simulation to one of the room.
  [[nodiscard]] std::uint64_t tickOf(std::uint64_t sim_tick) const { return sim_tick + tick_shift_; }
  /// Number of the present state; it grows with every tick and every change by apply() and replaceWater(). Never 0.
  [[nodiscard]] std::uint64_t stateId() const { return state_id_; }
  /// Id that the last applied SpawnBoat or SpawnFloater gave out.
  [[nodiscard]] std::uint32_t spawnedId() const { return spawned_id_; }
  /// The boats on the water now.
  [[nodiscard]] v1::BoatList boats() const;
  [[nodiscard]] std::set<std::uint32_t> boatIds() const;

 private:
  using Handler = Outcome (*)(RoomWater& room, const v1::Command& command);
  /// Returns the handler of a command; null if it does not change the water.
  static Handler handlerOf(v1::Command::ActionCase action);
  Outcome reset(const v1::Reset& reset);
  Outcome setParameter(const v1::SetParameter& change);
  /// Keeps the id of what was added, or rejects the command of that name.
  Outcome spawned(const core::Result<std::uint32_t>& id, const char* action);
  /// Exchanges the waters between two ticks.
  void exchange(std::unique_ptr<Water>& water);

  void setScene(v1::Scene scene) {
    water_->scene() = std::move(scene);
    ++scene_version_;
  }

  std::unique_ptr<Water> water_;
  std::uint64_t tick_shift_ = 0;  ///< room tick minus simulation tick, modulo 2^64
  std::uint64_t state_id_ = 1;
  std::uint64_t scene_version_ = 1;
  std::uint32_t spawned_id_ = 0;
};

}  // namespace spindrift::water
