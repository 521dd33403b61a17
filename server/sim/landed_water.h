// The momentum of particles that become water again, in two-way scenes with a nonlinear bulk: particle passes add what
// lands on each wave cell, and mix() makes it part of the flow.
#pragma once

#include <memory>

#include <spindrift/core/result.h>
#include <spindrift/gpu/buffer.h>
#include <spindrift/gpu/program.h>
#include <spindrift/sim_setup/derive.h>

#include "wave.h"

namespace spindrift::sim {

class LandedWater {
 public:
  /// Errors: those of the buffer and the program.
  static core::Result<std::unique_ptr<LandedWater>> create(gpu::Context& ctx, const WaveLayout& layout,
                                                           const gpu::Defines& defines);

  /// Binds LANDED_WATER for the passes that absorb particles.
  void bind() const;
  /// Mixes what has landed in this tick with the water, and begins again at nothing.
  void mix(Wave& wave);
  void clear() { landed_.clear(); }
  void declareState(StateBuffers& out) { out.push_back({.buffer = &landed_, .lasts = false}); }

 private:
  LandedWater(gpu::Context& ctx, const WaveLayout& layout) : ctx_(ctx), count_(layout.counts()) {}

  gpu::Context& ctx_;
  core::CellCounts count_;
  gpu::Buffer landed_;  ///< words as coupling/landed_water.glsl says
  gpu::Program mix_;
};

}  // namespace spindrift::sim
