#include "stir.h"

#include <cmath>

#include <shared/bindings.h>

namespace spindrift::sim {

Stir::Stir(Creation& create)
    : event_uniforms_(create.uniforms<shared::EventUniforms>("event uniforms")), pass_(create.pass("sph/stir.comp")) {}

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
  particles.position.bindStorage(POSITION);
  particles.velocity.bindStorage(VELOCITY);
  population.forParticles(pass_);
}

}  // namespace spindrift::sim
