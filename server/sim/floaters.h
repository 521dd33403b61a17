// Floaters: the list of objects in the water (host) and their motion (device). See shaders/shared/floaters.h, and
// shaders/bodies for the equations.
#pragma once

#include <cstdint>
#include <vector>

#include <shared/floaters.h>

#include <spindrift/sim/water_sim.h>

#include "boats.h"
#include "creation.h"
#include "particle_buffers.h"
#include "particle_pool.h"
#include "wave.h"

namespace spindrift::sim {

class Floaters {
 public:
  Floaters(Creation& create, const core::Scene& scene);

  /// Keeps only the scene's own floaters, as at the start. Ids of others are not reused, unless all have been used.
  void reset(const core::Scene& scene);
  void declareState(StateBuffers& out);
  /// Everything but the device's state, and its replacement.
  /// The next reset() numbers from 1 again.
  void numberAfresh() { next_id_ = 1; }
  [[nodiscard]] CarriedFloaters carried() const { return {places_, next_id_}; }
  void takeOver(const CarriedFloaters& carried);
  /// Returns whether takeOver() may be called: as many slots as here.
  [[nodiscard]] bool fits(const CarriedFloaters& carried) const { return carried.places.size() == places_.size(); }
  /// Returns the new floater's id. When all slots are taken it replaces the oldest stone, or else the oldest floater
  /// that is not the scene's own; kUnavailable when all are.
  core::Result<std::uint32_t> spawn(const core::Floater& floater);
  /// kInvalidInput for an unknown floater.
  core::Result<void> hold(const FloaterHold& hold);
  core::Result<void> remove(std::uint32_t floater_id);
  void removeAll();
  /// For recovery: puts floaters whose state is not finite back to their starting positions. Waits for the device.
  void mend();

  /// Moves the floaters by a tick with their contacts: to the time of the surface. What they give to boats
  /// acts in Boats::move(), which comes next.
  void move(double tick_s, const Wave& wave, Boats* boats);
  /// Moves particles that have entered floaters in this substep out, and gives the floaters the momentum that these
  /// lose. Call it after move() of the same tick, with the surface bound. `moved_s`: what move() has moved them since
  /// the last substep, a tick in the first and 0 in others. Only in scenes with particles.
  void meetParticles(double moved_s, const ParticleBuffers& particles, const Population& population);
  /// Sets their accelerations for the next tick. Call it after Wave::sampleSurface() and before Wave::clearPressure().
  void feel(double tick_s, Wave& wave);
  /// Adds their pressure to the pressure head.
  void press(const gpu::TexelBuffer& pressure_head);
  /// Binds FLOATERS for passes that read all slots. They find their number in the size of the buffer: zink 22.3 keeps
  /// the first value of a plain uniform that decides a branch or a loop.
  void bind() const;
  [[nodiscard]] std::uint32_t count() const;

 private:
  core::Result<std::size_t> find(std::uint32_t floater_id) const;
  void put(std::size_t slot, std::uint32_t floater_id, const core::Floater& floater);
  void countSlots();

  std::vector<FloaterPlace> places_;
  std::uint32_t slot_count_ = 0;  ///< slots to look at: all floaters are below
  std::uint32_t own_count_;       ///< the scene's own have the ids from 1 to this one
  std::uint32_t next_id_ = 1;
  gpu::TexelBuffer state_, reach_;
  gpu::Buffer tiles_, near_, push_;
  Pass mark_tiles_, find_near_, contacts_, move_, water_, press_;
  Pass count_hits_, hits_, recoil_;  ///< only in scenes with particles
};

}  // namespace spindrift::sim
