// Weakly compressible SPH on the sorted particles (thesis 3.3, 3.6.2): density and pressure, forces, integration.
#pragma once

#include <memory>

#include <spindrift/core/result.h>
#include <spindrift/gpu/program.h>
#include <spindrift/sim_setup/derive.h>

#include "particle_buffers.h"
#include "particle_pool.h"

namespace spindrift::sim {

class Sph {
 public:
  static core::Result<std::unique_ptr<Sph>> create(gpu::Context& ctx, const gpu::Defines& defines);

  // Call these in this order, after NeighborGrid::build(), with CELL_START and (in coupled scenes) the surface bound.
  void density(const ParticleBuffers& particles, const Population& population);
  void forces(const ParticleBuffers& particles, const Population& population);
  void integrate(const ParticleBuffers& particles, const Population& population);

 private:
  explicit Sph(gpu::Context& ctx) : ctx_(ctx) {}

  gpu::Context& ctx_;
  gpu::Program density_, force_, integrate_;
};

}  // namespace spindrift::sim
