#include "stir.h"

#include <cmath>

#include <shared/bindings.h>

#include "create_all.h"

namespace spindrift::sim {

core::Result<std::unique_ptr<Stir>> Stir::create(gpu::Context& ctx, const gpu::Defines& defines) {
  auto out = std::unique_ptr<Stir>(new Stir(ctx));
  Creation create;
  create(out->event_uniforms_,
         gpu::Buffer::create(ctx, "event uniforms", sizeof(shared::EventUniforms), gpu::BufferUse::kUpdatable));
  create(out->program_, gpu::Program::create(ctx, "sph/stir.comp", defines));
  if (create.error()) return *create.error();
  return out;
}

EffectDomain Stir::domain(const core::Scene& scene, const Derived& derived) {
  const ParticleLayout& l = *derived.particles;
  return {.side_x_m = l.max_m[0] - l.min_m[0],
          .side_z_m = l.max_m[2] - l.min_m[2],
          .cell_m = l.spacing_m,
          .speed_mps = std::sqrt(scene.gravity_mps2 * l.band_m),
          .dt_s = derived.tick_s};
}

void Stir::apply(const shared::EventUniforms& events, const ParticleBuffers& particles, const Population& population) {
  if (events.splash_count + events.crest_count + events.calm_count == 0) return;
  event_uniforms_.uploadValue(events);
  event_uniforms_.bindUniform(EVENT_UNIFORMS);
  population.bind();
  particles.position.bindStorage(POSITION);
  particles.velocity.bindStorage(VELOCITY);
  population.forParticles(program_);
  ctx_.barrier(gpu::Barrier::kStorageAndTexel);
}

}  // namespace spindrift::sim
