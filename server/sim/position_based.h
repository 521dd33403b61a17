// Position-based fluids (Macklin & Mueller 2013): positions are moved until the density is right. There is no speed of
// sound, so only the particles' own speed limits the step.
#pragma once

#include <memory>

#include <spindrift/core/result.h>
#include <spindrift/gpu/program.h>
#include <spindrift/sim_setup/derive.h>

#include "particle_buffers.h"
#include "particle_pool.h"

namespace spindrift::sim {

class PositionBased {
 public:
  static core::Result<std::unique_ptr<PositionBased>> create(gpu::Context& ctx, const gpu::Defines& defines);

  /// Call it before NeighborGrid::build(): replaces position and velocity by the predicted ones. Coupled scenes need
  /// the surface bound, here and in the functions below.
  void predict(const ParticleBuffers& particles, const Population& population);
  // Call these after build(), in this order, with CELL_START bound.
  void project(const ParticleBuffers& particles, const Population& population, std::uint32_t iterations_count);
  void finish(const ParticleBuffers& particles, const Population& population);

 private:
  explicit PositionBased(gpu::Context& ctx) : ctx_(ctx) {}

  gpu::Context& ctx_;
  gpu::Program predict_, multiplier_, correct_, velocity_, finish_;
};

}  // namespace spindrift::sim
