// Effects in a scene without a wave: they move the particles themselves. See shaders/sph/stir.comp.
#pragma once

#include <spindrift/effects/effects.h>

#include "creation.h"
#include "particle_buffers.h"
#include "particle_pool.h"

namespace spindrift::sim {

class Stir {
 public:
  explicit Stir(Creation& create);

  /// Adds the effects of one tick to positions and velocities; does nothing without an active effect.
  void apply(const shared::EventUniforms& events, const ParticleBuffers& particles, const Population& population);

  /// The domain of effects in a scene without a wave: the particles' box, and long waves on its resting depth.
  static EffectDomain domain(const core::Scene& scene, const Derived& derived);

 private:
  gpu::Buffer event_uniforms_;
  Pass pass_;
};

}  // namespace spindrift::sim
