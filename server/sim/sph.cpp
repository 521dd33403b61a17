#include "sph.h"

#include <shared/bindings.h>

#include "create_all.h"

namespace spindrift::sim {

core::Result<std::unique_ptr<Sph>> Sph::create(gpu::Context& ctx, const gpu::Defines& defines) {
  auto sph = std::unique_ptr<Sph>(new Sph(ctx));
  Creation create;
  create(sph->density_, gpu::Program::create(ctx, "sph/density.comp", defines));
  create(sph->force_, gpu::Program::create(ctx, "sph/force.comp", defines));
  create(sph->integrate_, gpu::Program::create(ctx, "sph/integrate.comp", defines));
  if (create.error()) return *create.error();
  return sph;
}

void Sph::density(const ParticleBuffers& particles, const Population& population) {
  population.bind();
  particles.sorted_position.bindTexel(SORTED_POSITION);
  particles.sorted_velocity.bindTexel(SORTED_VELOCITY);
  particles.pressure_point.bindStorage(PRESSURE_POINT);
  particles.motion_point.bindStorage(MOTION_POINT);
  particles.acceleration.bindStorage(ACCELERATION);
  if (particles.foam_source) particles.foam_source.bindStorage(FOAM_SOURCE);
  population.forParticles(density_);
  ctx_.barrier(gpu::Barrier::kStorageAndTexel);
}

void Sph::forces(const ParticleBuffers& particles, const Population& population) {
  population.bind();
  particles.pressure_point.bindTexel(PRESSURE_POINT);
  particles.motion_point.bindTexel(MOTION_POINT);
  particles.acceleration.bindStorage(ACCELERATION);
  population.forParticles(force_);
  ctx_.barrier(gpu::Barrier::kStorageAndTexel);
}

void Sph::integrate(const ParticleBuffers& particles, const Population& population) {
  population.bind();
  particles.acceleration.bindTexel(ACCELERATION);
  if (particles.foam_source) particles.foam_source.bindTexel(FOAM_SOURCE);
  particles.position.bindStorage(POSITION);
  particles.velocity.bindStorage(VELOCITY);
  population.forParticles(integrate_);
  // One buffer holds both the count of absorbed particles and the group counts of the next pass.
  ctx_.barrier(gpu::Barrier::kStorageAndTexel | gpu::Barrier::kIndirect);
}

}  // namespace spindrift::sim
