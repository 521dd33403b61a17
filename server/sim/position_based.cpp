#include "position_based.h"

#include <shared/bindings.h>

#include "create_all.h"

namespace spindrift::sim {

core::Result<std::unique_ptr<PositionBased>> PositionBased::create(gpu::Context& ctx, const gpu::Defines& defines) {
  auto out = std::unique_ptr<PositionBased>(new PositionBased(ctx));
  Creation create;
  create(out->predict_, gpu::Program::create(ctx, "pbf/predict.comp", defines));
  create(out->multiplier_, gpu::Program::create(ctx, "pbf/multiplier.comp", defines));
  create(out->correct_, gpu::Program::create(ctx, "pbf/correct.comp", defines));
  create(out->velocity_, gpu::Program::create(ctx, "pbf/velocity.comp", defines));
  create(out->finish_, gpu::Program::create(ctx, "pbf/finish.comp", defines));
  if (create.error()) return *create.error();
  return out;
}

void PositionBased::predict(const ParticleBuffers& particles, const Population& population) {
  population.bind();
  particles.position.bindStorage(POSITION);
  particles.velocity.bindStorage(VELOCITY);
  population.forParticles(predict_);
  ctx_.barrier(gpu::Barrier::kStorageAndTexel);
}

void PositionBased::project(const ParticleBuffers& particles, const Population& population,
                            std::uint32_t iterations_count) {
  population.bind();
  for (std::uint32_t k = 0; k < iterations_count; ++k) {
    // The first iteration reads the predicted positions, each later one the result of the one before.
    const gpu::TexelBuffer& iterate = k == 0 ? particles.sorted_position : particles.motion_point;
    iterate.bindTexel(SORTED_POSITION);
    particles.pressure_point.bindStorage(PRESSURE_POINT);
    particles.acceleration.bindStorage(ACCELERATION);
    population.forParticles(multiplier_);
    ctx_.barrier(gpu::Barrier::kStorageAndTexel);
    particles.pressure_point.bindTexel(PRESSURE_POINT);
    particles.motion_point.bindStorage(MOTION_POINT);
    population.forParticles(correct_);
    ctx_.barrier(gpu::Barrier::kStorageAndTexel);
  }
}

void PositionBased::finish(const ParticleBuffers& particles, const Population& population) {
  population.bind();
  particles.sorted_position.bindTexel(SORTED_POSITION);
  particles.sorted_velocity.bindTexel(SORTED_VELOCITY);
  particles.motion_point.bindTexel(MOTION_POINT);
  particles.pressure_point.bindStorage(PRESSURE_POINT);
  particles.acceleration.bindStorage(ACCELERATION);
  population.forParticles(velocity_);
  ctx_.barrier(gpu::Barrier::kStorageAndTexel);
  particles.pressure_point.bindTexel(PRESSURE_POINT);
  particles.acceleration.bindTexel(ACCELERATION);
  particles.position.bindStorage(POSITION);
  particles.velocity.bindStorage(VELOCITY);
  population.forParticles(finish_);
  // One buffer holds both the count of absorbed particles and the group counts of the next pass.
  ctx_.barrier(gpu::Barrier::kStorageAndTexel | gpu::Barrier::kIndirect);
}

}  // namespace spindrift::sim
