// Boats: the list of boats (host) and their motion (device). See shaders/shared/boats.h and shaders/bodies.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <shared/bindings.h>
#include <shared/boats.h>

#include <spindrift/sim/hull_forces.h>
#include <spindrift/sim_state/carried_state.h>

#include "creation.h"
#include "moved_hulls.h"
#include "wave.h"

namespace spindrift::sim {

class Boats {
 public:
  Boats(Creation& create, const core::Scene& scene, double cell_m);

  /// Keeps only the scene's own boats, at their starting positions and with their first ids. Ids of other boats are not
  /// reused.
  void reset(const core::Scene& scene);
  /// Sets the first id; the scene's own boats come first. Takes effect with the next reset().
  void numberFrom(std::uint32_t first_id) { first_id_ = next_id_ = first_id; }
  /// Returns a number above every id in use or used before.
  [[nodiscard]] std::uint32_t nextId() const { return next_id_; }
  /// Its state on the device, which recovery mends.
  void declareState(StateBuffers& out);
  /// Everything but the device's state, and its replacement.
  [[nodiscard]] CarriedBoats carried() const { return {places_, first_id_, next_id_}; }
  void takeOver(const CarriedBoats& carried);
  /// Returns whether takeOver() may be called: as many slots as here.
  [[nodiscard]] bool fits(const CarriedBoats& carried) const { return carried.places.size() == places_.size(); }
  /// Returns the new boat's id. kUnavailable when all slots or all ids are taken.
  core::Result<std::uint32_t> spawn(const core::Boat& boat);
  /// kInvalidInput for an unknown boat.
  core::Result<void> control(std::uint32_t boat_id, double throttle_ratio, double rudder_ratio);
  core::Result<void> remove(std::uint32_t boat_id);

  /// Sets the pose and the velocities of a boat, for the next kMovedFor_s: until then only place() moves it further.
  /// What it presses with in the next tick is that of its new pose. kInvalidInput for an unknown boat.
  core::Result<void> place(const HullMotion& motion, Wave& wave);
  /// The water moves the boat again. kInvalidInput for an unknown boat.
  core::Result<void> release(std::uint32_t boat_id, Wave& wave);
  /// Returns whether somebody moves a boat.
  [[nodiscard]] bool anyMoved() const { return moved_count_ > 0; }
  /// Makes the passes for moved boats; call it before place(), and after takeOver() if anyMoved().
  core::Result<void> prepareMoved(Creation& create);
  /// Adds the pressure on moved hulls in the wave step to come; `begins`: the first of a tick.
  void feel(Wave& wave, bool begins);
  /// Ends the tick of moved boats: reads the forces on them back, and lets go of those whose time is over. `tick`:
  /// after it. Call it between move() and press().
  void endMovedTick(Wave& wave, std::uint64_t tick, double tick_s, double water_kgpm3);
  std::vector<HullForces> takeForces() { return moved_ ? moved_->poll() : std::vector<HullForces>(); }
  [[nodiscard]] std::size_t forcesInFlight() const { return moved_ ? moved_->inFlightCount() : 0; }

  /// For recovery: puts boats whose state is not finite back to their starting positions. Waits for the device.
  void mend();

  /// Advances the boats by one tick; call it after Wave::sampleSurface(). Without a wave boats float at the resting
  /// level and act on particles only.
  void move(const Wave* wave);
  /// Adds the pressure of the hulls to the pressure head.
  void press(Wave& wave);
  /// Binds BOATS and their controls for passes that read hulls.
  void bind() const;
  /// Binds BOAT_PUSH, to which floaters add before move(). Only in scenes with floaters.
  void bindPush() const { push_.bindStorage(BOAT_PUSH); }

  [[nodiscard]] std::vector<BoatRecord> records() const;
  [[nodiscard]] std::uint32_t count() const;

 private:
  core::Result<std::size_t> find(std::uint32_t boat_id) const;
  void uploadControls();
  /// Cells along each axis that every hull's pressure fits into.
  [[nodiscard]] std::uint32_t pressedCells() const;
  /// Adds the pressure of one boat to the head, or takes it away.
  void pressOne(std::size_t at, int sign, Wave& wave);
  void setMoved(std::size_t at, double left_s);
  void countMoved();

  double cell_m_;
  std::vector<BoatPlace> places_;  ///< BoatsScene.capacity_count
  std::size_t slot_count_;         ///< of the device's buffers, at least as many
  std::uint32_t first_id_ = 1;
  std::uint32_t next_id_ = 1;  ///< never decreases
  shared::BoatControls controls_{};
  gpu::TexelBuffer state_;
  gpu::Buffer control_uniforms_;
  gpu::Buffer push_;  ///< of floaters; zero but between their move and that of the boats. Empty in scenes without
  Pass drift_, kick_, press_;
  std::unique_ptr<MovedHulls> moved_;  ///< from the first moved boat on
  std::size_t moved_count_ = 0;
};

}  // namespace spindrift::sim
