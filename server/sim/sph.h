// Weakly compressible SPH on the sorted particles (thesis 3.3, 3.6.2): density and pressure, forces, integration.
#pragma once

#include <memory>

#include <spindrift/core/result.h>
#include <spindrift/gpu/program.h>
#include <spindrift/sim/derive.h>

#include "particle_buffers.h"

namespace spindrift::sim {

class Sph {
 public:
  static core::Result<std::unique_ptr<Sph>> create(gpu::Context& ctx, const ParticleLayout& layout,
                                                   const gpu::Defines& defines);

  /// Another number of particles, the same programs.
  void resize(const ParticleLayout& layout) { count_ = layout.count; }

  // In this order, after NeighborGrid::build(), with CELL_START and (in coupled scenes) the surface bound.
  void density(const ParticleBuffers& particles);
  void forces(const ParticleBuffers& particles);
  void integrate(const ParticleBuffers& particles);

 private:
  Sph(gpu::Context& ctx, const ParticleLayout& layout) : ctx_(ctx), count_(layout.count) {}

  gpu::Context& ctx_;
  std::uint32_t count_;
  gpu::Program density_, force_, integrate_;
};

}  // namespace spindrift::sim
