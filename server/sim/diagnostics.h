// Health and energies of the room, from one small reduction per tick. Results arrive some ticks later; nothing waits
// for them.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <spindrift/core/result.h>
#include <spindrift/core/scene.h>
#include <spindrift/gpu/buffer.h>
#include <spindrift/gpu/program.h>
#include <spindrift/gpu/readback_ring.h>
#include <spindrift/sim/health.h>
#include <spindrift/sim_setup/derive.h>

#include "boats.h"
#include "breakers.h"
#include "gauges.h"
#include "neighbor_grid.h"
#include "particle_buffers.h"
#include "particle_pool.h"
#include "wave.h"

namespace spindrift::sim {

class Diagnostics {
 public:
  static core::Result<std::unique_ptr<Diagnostics>> create(gpu::Context& ctx, const core::Scene& scene,
                                                           const Derived& derived, const gpu::Defines& defines);

  /// Replaces the buffers for another number of particles and keeps the programs. Results in flight are lost. An error
  /// changes nothing.
  core::Result<void> resize(const Derived& derived);

  /// Measures the state after `tick`; absent parts are null. There is one slot per tick that may be in flight
  /// (TicksInFlight), so every tick is measured if poll() is called before each call.
  void measure(std::uint64_t tick, const ParticleBuffers* particles, const Population* population,
               const NeighborGrid* grid, Wave* wave, Breakers* breakers, const Boats* boats);
  /// Returns the results that have arrived, oldest first.
  std::vector<Health> poll(const core::Scene& scene, const Derived& derived);

 private:
  explicit Diagnostics(gpu::Context& ctx) : ctx_(ctx) {}
  /// Where the words of the pool, and then the readings of the gauges, begin in a slot.
  [[nodiscard]] std::size_t poolOffset() const;
  [[nodiscard]] std::size_t gaugeOffset() const;

  gpu::Context& ctx_;
  std::uint32_t particle_shares_ = 0;
  std::uint32_t surface_shares_ = 0;
  std::uint32_t cells_ = 0;
  std::uint32_t particles_ = 0;
  bool is_pooled_ = false;
  std::int64_t resting_units_ = 0;    ///< Wave::restingUnits()
  std::uint32_t crowded_before_ = 0;  ///< NeighborGrid::crowded() of the last result
  gpu::Buffer particle_sums_, surface_sums_;
  gpu::Program particle_program_, surface_program_;
  std::unique_ptr<Gauges> gauges_;  ///< null in scenes without gauges
  std::unique_ptr<gpu::ReadbackRing> ring_;
};

}  // namespace spindrift::sim
