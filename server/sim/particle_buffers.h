// Particle state on the device; shaders/shared/bindings.h has the layout of each buffer.
#pragma once

#include <cstddef>

#include <spindrift/sim/state_buffer.h>

#include "creation.h"

namespace spindrift::sim {

/// Between steps only `position`, `velocity` and the density in `acceleration.w` are valid; each step computes the
/// rest.
struct ParticleBuffers {
  gpu::TexelBuffer position, velocity;
  gpu::TexelBuffer sorted_position, sorted_velocity;
  gpu::TexelBuffer pressure_point, motion_point, acceleration;
  gpu::TexelBuffer near_candidates;   ///< see grid/candidates.glsl
  gpu::TexelBuffer foam_source;       ///< only where storesFoamSource()
  gpu::TexelBuffer surface_gradient;  ///< only where hasTension()

  ParticleBuffers() = default;
  ParticleBuffers(Creation& create, std::size_t count, bool stores_foam_source, bool has_tension);
  /// Gives every particle the same density; accelerations are recomputed before they are read.
  void setDensity(double density_kgpm3);
  void declareState(StateBuffers& out);
};

}  // namespace spindrift::sim
