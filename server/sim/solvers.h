// The two solvers of the particles. Both work on the sorted particles of NeighborGrid::build(), with CELL_START and (in
// coupled scenes) the surface bound.
#pragma once

#include <cstdint>

#include "creation.h"
#include "particle_buffers.h"
#include "particle_pool.h"

namespace spindrift::sim {

/// Weakly compressible SPH (thesis 3.3, 3.6.2): density and pressure, forces, integration.
class Sph {
 public:
  explicit Sph(Creation& create);

  // Call these in this order.
  void density(const ParticleBuffers& particles, const Population& population);
  void forces(const ParticleBuffers& particles, const Population& population);
  void integrate(const ParticleBuffers& particles, const Population& population);

 private:
  Pass density_, force_, integrate_;
};

/// Position-based fluids (Macklin & Mueller 2013): positions are moved until the density is right. There is no speed of
/// sound, so only the particles' own speed limits the step.
class PositionBased {
 public:
  explicit PositionBased(Creation& create);

  /// Call it before NeighborGrid::build(): replaces position and velocity by the predicted ones.
  void predict(const ParticleBuffers& particles, const Population& population);
  // Call these after build(), in this order.
  void project(const ParticleBuffers& particles, const Population& population, std::uint32_t iterations_count);
  void finish(const ParticleBuffers& particles, const Population& population);

 private:
  Pass predict_, multiplier_, correct_, velocity_, finish_;
};

}  // namespace spindrift::sim
