// Effects in a scene without a wave: they move the particles themselves. See shaders/sph/stir.comp.
#pragma once

#include <memory>

#include <shared/event_uniforms.h>

#include <spindrift/core/result.h>
#include <spindrift/effects/effects.h>
#include <spindrift/gpu/buffer.h>
#include <spindrift/gpu/program.h>
#include <spindrift/sim_setup/derive.h>

#include "particle_buffers.h"
#include "particle_pool.h"

namespace spindrift::sim {

class Stir {
 public:
  static core::Result<std::unique_ptr<Stir>> create(gpu::Context& ctx, const gpu::Defines& defines);

  /// Adds the effects of one tick to positions and velocities; does nothing without an active effect.
  void apply(const shared::EventUniforms& events, const ParticleBuffers& particles, const Population& population);

  /// The domain of effects in a scene without a wave: the particles' box, and long waves on its resting depth.
  static EffectDomain domain(const core::Scene& scene, const Derived& derived);

 private:
  explicit Stir(gpu::Context& ctx) : ctx_(ctx) {}

  gpu::Context& ctx_;
  gpu::Buffer event_uniforms_;
  gpu::Program program_;
};

}  // namespace spindrift::sim
