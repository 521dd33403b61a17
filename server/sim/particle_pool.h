// The particles of a two-way scene: water that broke. The pool plans emission and counts particles; sph/integrate.comp
// returns them to the water. All counts are on the device, and passes over the particles are dispatched indirectly, so
// calm water costs one invocation.
#pragma once

#include <memory>

#include <spindrift/core/result.h>
#include <spindrift/core/scene.h>
#include <spindrift/gpu/buffer.h>
#include <spindrift/gpu/program.h>
#include <spindrift/sim_setup/derive.h>

#include "particle_buffers.h"
#include "wave.h"

namespace spindrift::sim {

class ParticlePool {
 public:
  static core::Result<std::unique_ptr<ParticlePool>> create(gpu::Context& ctx, const ParticleLayout& layout,
                                                            const gpu::Defines& defines);

  void clear() { words_.clear(); }
  void declareState(StateBuffers& out) { out.push_back({.buffer = &words_, .checkpoint = true, .carried = true}); }
  /// Plans the dispatches of a substep: emission from the cells that Breakers::update() counted, passes over the live
  /// particles.
  void plan();
  /// Emits particles; call it after plan().
  void emit(const ParticleBuffers& particles, Wave& wave, const gpu::TexelBuffer& breaking, std::uint32_t tick);

  /// POOL_WORDS words, see shaders/shared/pool.h.
  [[nodiscard]] gpu::TexelBuffer& words() { return words_; }
  [[nodiscard]] const gpu::TexelBuffer& words() const { return words_; }
  /// Cells that emit in this tick.
  [[nodiscard]] const gpu::TexelBuffer& emitters() const { return emitters_; }

 private:
  explicit ParticlePool(gpu::Context& ctx) : ctx_(ctx) {}

  gpu::Context& ctx_;
  gpu::TexelBuffer words_, emitters_;
  gpu::Program plan_, emit_;
};

/// Sizes of the dispatches over particles, grid cells and scan blocks: fixed numbers, or the counts of the pool.
class Population {
 public:
  Population(std::uint32_t count, std::uint32_t cell_count, const ParticlePool* pool)
      : count_(count), cell_count_(cell_count), pool_(pool) {}

  void forParticles(gpu::Program& program) const;
  /// Covers cell_count + 1 invocations, or fewer that loop over them: at most MAX_GROUPS groups.
  void forCells(gpu::Program& program) const;
  void forScanBlocks(gpu::Program& program) const;  ///< covers cell_count + 1
  void forOneGroup(gpu::Program& program) const;
  /// Makes the counts visible to the passes. Does nothing without a pool.
  void bind() const;
  [[nodiscard]] const ParticlePool* pool() const { return pool_; }

 private:
  std::uint32_t count_;
  std::uint32_t cell_count_;
  const ParticlePool* pool_;
};

}  // namespace spindrift::sim
