// Position-based fluids (Macklin & Mueller 2013): positions are moved until the density is right. No speed of sound, so
// steps are bound by the particles' own speed alone.
#pragma once

#include <memory>

#include <spindrift/core/result.h>
#include <spindrift/gpu/program.h>
#include <spindrift/sim/derive.h>

#include "particle_buffers.h"
#include "particle_pool.h"

namespace spindrift::sim {

class PositionBased {
 public:
  static core::Result<std::unique_ptr<PositionBased>> create(gpu::Context& ctx, const gpu::Defines& defines);

  /// Before NeighborGrid::build(): position and velocity become the predicted ones. In coupled scenes with the surface
  /// bound, like the rest.
  void predict(const ParticleBuffers& particles, const Population& population);
  // After it, in this order, with CELL_START bound.
  void project(const ParticleBuffers& particles, const Population& population, std::uint32_t iterations_count);
  void finish(const ParticleBuffers& particles, const Population& population);

 private:
  explicit PositionBased(gpu::Context& ctx) : ctx_(ctx) {}

  gpu::Context& ctx_;
  gpu::Program predict_, multiplier_, correct_, velocity_, finish_;
};

}  // namespace spindrift::sim
