// The particles of a two-way scene: water that broke. Emission, and how many there are; they return to the water in
// sph/integrate.comp. All counts live on the device, passes over the particles are dispatched from there, and calm
// water dispatches nothing but one invocation.
#pragma once

#include <memory>

#include <spindrift/core/result.h>
#include <spindrift/core/scene.h>
#include <spindrift/gpu/buffer.h>
#include <spindrift/gpu/program.h>
#include <spindrift/sim/derive.h>

#include "particle_buffers.h"
#include "wave.h"

namespace spindrift::sim {

class ParticlePool {
 public:
  static core::Result<std::unique_ptr<ParticlePool>> create(gpu::Context& ctx, const ParticleLayout& layout,
                                                            const gpu::Defines& defines);

  void clear() { words_.clear(); }
  /// Plans the dispatches of a substep: emission of what Breakers::update() counted, passes over the particles there
  /// are.
  void plan();
  /// Emits, after plan().
  void emit(const ParticleBuffers& particles, Wave& wave, const gpu::TexelBuffer& breaking, std::uint32_t tick);

  /// POOL_WORDS words, shaders/shared/pool.h.
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

/// Whom a pass over particles, grid cells or scan blocks is for: a fixed number, or what the pool says.
class Population {
 public:
  Population(std::uint32_t count, std::uint32_t cell_count, const ParticlePool* pool)
      : count_(count), cell_count_(cell_count), pool_(pool) {}

  void forParticles(gpu::Program& program) const;
  /// cell_count + 1, or fewer invocations that loop over them: at most MAX_GROUPS groups.
  void forCells(gpu::Program& program) const;
  void forScanBlocks(gpu::Program& program) const;  ///< groups that cover cell_count + 1
  void forOneGroup(gpu::Program& program) const;
  /// Makes the counts visible to the passes. Nothing without a pool.
  void bind() const;
  [[nodiscard]] const ParticlePool* pool() const { return pool_; }

 private:
  std::uint32_t count_;
  std::uint32_t cell_count_;
  const ParticlePool* pool_;
};

}  // namespace spindrift::sim
