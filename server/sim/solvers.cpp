#include "solvers.h"

#include <shared/bindings.h>

namespace spindrift::sim {

Sph::Sph(Creation& create)
    : density_(create.pass("sph/density.comp")),
      force_(create.pass("sph/force.comp")),
      integrate_(create.pass("sph/integrate.comp")) {}

void Sph::density(const ParticleBuffers& particles, const Population& population) {
  particles.sorted_position.bindTexel(SORTED_POSITION);
  particles.sorted_velocity.bindTexel(SORTED_VELOCITY);
  particles.pressure_point.bindStorage(PRESSURE_POINT);
  particles.motion_point.bindStorage(MOTION_POINT);
  particles.acceleration.bindStorage(ACCELERATION);
  particles.near_candidates.bindStorage(NEAR_CANDIDATES);
  if (particles.foam_source) particles.foam_source.bindStorage(FOAM_SOURCE);
  if (particles.surface_gradient) particles.surface_gradient.bindStorage(SURFACE_GRADIENT);
  population.forParticles(density_);
}

void Sph::forces(const ParticleBuffers& particles, const Population& population) {
  particles.pressure_point.bindTexel(PRESSURE_POINT);
  particles.motion_point.bindTexel(MOTION_POINT);
  particles.acceleration.bindStorage(ACCELERATION);
  particles.near_candidates.bindTexel(NEAR_CANDIDATES);
  if (particles.surface_gradient) particles.surface_gradient.bindTexel(SURFACE_GRADIENT);
  population.forParticles(force_);
}

void Sph::integrate(const ParticleBuffers& particles, const Population& population) {
  particles.acceleration.bindTexel(ACCELERATION);
  if (particles.foam_source) particles.foam_source.bindTexel(FOAM_SOURCE);
  particles.position.bindStorage(POSITION);
  particles.velocity.bindStorage(VELOCITY);
  population.forParticles(integrate_);
}

PositionBased::PositionBased(Creation& create)
    : predict_(create.pass("pbf/predict.comp")),
      multiplier_(create.pass("pbf/multiplier.comp")),
      correct_(create.pass("pbf/correct.comp")),
      velocity_(create.pass("pbf/velocity.comp")),
      finish_(create.pass("pbf/finish.comp")) {}

void PositionBased::predict(const ParticleBuffers& particles, const Population& population) {
  particles.position.bindStorage(POSITION);
  particles.velocity.bindStorage(VELOCITY);
  population.forParticles(predict_);
}

void PositionBased::project(const ParticleBuffers& particles, const Population& population,
                            std::uint32_t iterations_count) {
  for (std::uint32_t k = 0; k < iterations_count; ++k) {
    // The first iteration reads the predicted positions, each later one the result of the one before.
    const gpu::TexelBuffer& iterate = k == 0 ? particles.sorted_position : particles.motion_point;
    iterate.bindTexel(SORTED_POSITION);
    particles.pressure_point.bindStorage(PRESSURE_POINT);
    particles.acceleration.bindStorage(ACCELERATION);
    if (particles.surface_gradient) particles.surface_gradient.bindStorage(SURFACE_GRADIENT);
    particles.near_candidates.bindStorage(NEAR_CANDIDATES);
    population.forParticles(multiplier_);
    particles.near_candidates.bindTexel(NEAR_CANDIDATES);
    particles.pressure_point.bindTexel(PRESSURE_POINT);
    particles.motion_point.bindStorage(MOTION_POINT);
    population.forParticles(correct_);
  }
}

void PositionBased::finish(const ParticleBuffers& particles, const Population& population) {
  particles.sorted_position.bindTexel(SORTED_POSITION);
  particles.sorted_velocity.bindTexel(SORTED_VELOCITY);
  particles.motion_point.bindTexel(MOTION_POINT);
  particles.pressure_point.bindStorage(PRESSURE_POINT);
  particles.acceleration.bindStorage(ACCELERATION);
  population.forParticles(velocity_);
  particles.pressure_point.bindTexel(PRESSURE_POINT);
  particles.acceleration.bindTexel(ACCELERATION);
  particles.position.bindStorage(POSITION);
  particles.velocity.bindStorage(VELOCITY);
  if (particles.surface_gradient) particles.surface_gradient.bindTexel(SURFACE_GRADIENT);
  population.forParticles(finish_);
}

}  // namespace spindrift::sim
