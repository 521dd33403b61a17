// The particles of a two-way scene: water that broke. The pool plans emission and counts particles; sph/integrate.comp
// returns them to the water. All counts are on the device, and passes over the particles are dispatched indirectly, so
// calm water costs one invocation.
#pragma once

#include <cstdint>

#include <spindrift/core/scene.h>
#include <spindrift/sim_setup/derive.h>

#include "creation.h"
#include "particle_buffers.h"
#include "wave.h"

namespace spindrift::sim {

class ParticlePool {
 public:
  ParticlePool(Creation& create, const core::Scene& scene, const Derived& derived);

  void clear() { words_.clear(); }
  void declareState(StateBuffers& out);
  /// Plans the dispatches of a substep: emission from the cells that Breakers::update() counted, passes over the live
  /// particles.
  void plan();
  /// Emits particles; call it after plan().
  void emit(const ParticleBuffers& particles, Wave& wave, const gpu::TexelBuffer& breaking, std::uint32_t tick);

  /// Binds LANDED_WATER for the passes that absorb particles. They add the momentum of what lands on each wave cell.
  /// Does nothing with a linear bulk.
  void bindLanded() const;
  /// Mixes what has landed in this tick with the flow, and begins again at nothing. Only with a nonlinear bulk.
  void mix(Wave& wave);

  /// POOL_WORDS words, see shaders/shared/pool.h.
  [[nodiscard]] const gpu::TexelBuffer& words() const { return words_; }
  /// Cells that emit in this tick.
  [[nodiscard]] const gpu::TexelBuffer& emitters() const { return emitters_; }

 private:
  core::CellCounts wave_count_;
  gpu::TexelBuffer words_, emitters_;
  gpu::TexelBuffer landed_;  ///< words as coupling/landed_water.glsl says; only with a nonlinear bulk
  Pass plan_, emit_, mix_;
};

/// Runs passes over particles and runs of the scan: fixed numbers, or the counts of the pool.
class Population {
 public:
  Population(std::uint32_t count, const ParticlePool* pool) : count_(count), pool_(pool) {}

  void forParticles(Pass& pass) const;
  /// Covers run_count invocations, or fewer that loop over them: at most MAX_GROUPS groups.
  void forScanRuns(Pass& pass, std::uint32_t run_count) const;
  void forOneGroup(Pass& pass) const;
  /// Makes the counts visible to passes, as the functions above do. Does nothing without a pool.
  void bind() const;
  [[nodiscard]] const ParticlePool* pool() const { return pool_; }

 private:
  /// `arguments`: word of the pool with the number of groups.
  void run(Pass& pass, std::size_t arguments, std::uint32_t group_count) const;

  std::uint32_t count_;
  const ParticlePool* pool_;
};

}  // namespace spindrift::sim
