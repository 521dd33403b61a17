#include "particle_buffers.h"

#include <bit>
#include <cstdint>

namespace spindrift::sim {

ParticleBuffers::ParticleBuffers(Creation& create, std::size_t count, bool stores_foam_source, bool has_tension)
    : position(create.texels("position", count, gpu::TexelFormat::kRGBA32F)),
      velocity(create.texels("velocity", count, gpu::TexelFormat::kRGBA32F)),
      sorted_position(create.scratch("sorted position", count, gpu::TexelFormat::kRGBA32F)),
      sorted_velocity(create.scratch("sorted velocity", count, gpu::TexelFormat::kRGBA32F)),
      pressure_point(create.scratch("pressure point", count, gpu::TexelFormat::kRGBA32F)),
      motion_point(create.scratch("motion point", count, gpu::TexelFormat::kRGBA32F)),
      acceleration(create.texels("acceleration", count, gpu::TexelFormat::kRGBA32F)),
      near_candidates(create.scratch("near candidates", 9 * count, gpu::TexelFormat::kRG32UI)) {
  if (stores_foam_source) foam_source = create.scratch("foam source", count, gpu::TexelFormat::kR32F);
  if (has_tension) surface_gradient = create.scratch("surface gradient", count, gpu::TexelFormat::kRGBA32F);
}

void ParticleBuffers::setDensity(double density_kgpm3) {
  acceleration.clear(std::bit_cast<std::uint32_t>(static_cast<float>(density_kgpm3)));
}

void ParticleBuffers::declareState(StateBuffers& out) {
  out.push_back({.buffer = &position, .checkpoint = true, .carried = true, .per_particle = true});
  out.push_back({.buffer = &velocity, .checkpoint = true, .carried = true, .per_particle = true});
  out.push_back({.buffer = &acceleration, .per_particle = true});  // its density, for a frame before the next tick
}

}  // namespace spindrift::sim
