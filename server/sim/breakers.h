// Where the wave breaks (Kennedy et al. 2000), computed once per tick: the wave loses flow there and produces spray and
// foam.
#pragma once

#include <memory>
#include <utility>

#include <spindrift/core/result.h>
#include <spindrift/gpu/buffer.h>
#include <spindrift/gpu/program.h>
#include <spindrift/sim_setup/derive.h>

#include "particle_pool.h"
#include "wave.h"

namespace spindrift::sim {

class Breakers {
 public:
  static core::Result<std::unique_ptr<Breakers>> create(gpu::Context& ctx, const WaveLayout& layout,
                                                        const gpu::Defines& defines);

  void clear();
  void declareState(StateBuffers& out) { out.push_back({.buffer = &now_, .checkpoint = true, .carried = true}); }
  /// Call it after Wave::sampleSurface(). `pool` receives the list of emitting cells; null except in two-way scenes.
  void update(const Wave& wave, const ParticlePool* pool, std::uint32_t tick);

  /// nx x nz: seconds since the breaking event began, intensity 0..1, velocity of a splash's crown (x, z) [m/s].
  [[nodiscard]] gpu::TexelBuffer& state() { return now_; }

 private:
  Breakers(gpu::Context& ctx, const WaveLayout& layout) : ctx_(ctx), count_(layout.counts()) {}

  gpu::Context& ctx_;
  core::CellCounts count_;
  gpu::TexelBuffer now_, before_;
  gpu::Program program_;
};

}  // namespace spindrift::sim
