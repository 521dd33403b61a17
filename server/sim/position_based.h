// Position-based fluids (Macklin & Mueller 2013): positions are moved until the density is right. No speed of sound, so
// steps are bound by the particles' own speed alone.
#pragma once

#include <memory>

#include <spindrift/core/result.h>
#include <spindrift/gpu/program.h>
#include <spindrift/sim/derive.h>

#include "particle_buffers.h"

namespace spindrift::sim {

class PositionBased {
 public:
  static core::Result<std::unique_ptr<PositionBased>> create(gpu::Context& ctx, const ParticleLayout& layout,
                                                             const gpu::Defines& defines);
  /// Another number of particles, the same programs.
  void resize(const ParticleLayout& layout) { count_ = layout.count; }

  /// Before NeighborGrid::build(): position and velocity become the predicted ones. In coupled scenes with the surface
  /// bound, like the rest.
  void predict(const ParticleBuffers& particles);
  // After it, in this order, with CELL_START bound.
  void project(const ParticleBuffers& particles, std::uint32_t iterations_count);
  void finish(const ParticleBuffers& particles);

 private:
  PositionBased(gpu::Context& ctx, const ParticleLayout& layout) : ctx_(ctx), count_(layout.count) {}

  gpu::Context& ctx_;
  std::uint32_t count_;
  gpu::Program predict_, multiplier_, correct_, velocity_, finish_;
};

}  // namespace spindrift::sim
