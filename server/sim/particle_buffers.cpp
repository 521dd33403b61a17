#include "particle_buffers.h"

#include <bit>
#include <cstdint>

#include "create_all.h"

namespace spindrift::sim {

core::Result<ParticleBuffers> ParticleBuffers::create(gpu::Context& ctx, std::size_t count, bool stores_foam_source) {
  ParticleBuffers p;
  Creation create;
  const auto make = [&](gpu::TexelBuffer& buffer, const char* name, gpu::TexelFormat format,
                        gpu::BufferContent content = gpu::BufferContent::kZero) {
    create(buffer, gpu::TexelBuffer::create(ctx, name, count, format, content));
  };
  constexpr auto kScratch = gpu::BufferContent::kScratch;
  make(p.position, "position", gpu::TexelFormat::kRGBA32F);
  make(p.velocity, "velocity", gpu::TexelFormat::kRGBA32F);
  make(p.sorted_position, "sorted position", gpu::TexelFormat::kRGBA32F, kScratch);
  make(p.sorted_velocity, "sorted velocity", gpu::TexelFormat::kRGBA32F, kScratch);
  make(p.pressure_point, "pressure point", gpu::TexelFormat::kRGBA32F, kScratch);
  make(p.motion_point, "motion point", gpu::TexelFormat::kRGBA32F, kScratch);
  make(p.acceleration, "acceleration", gpu::TexelFormat::kRGBA32F);
  if (stores_foam_source) make(p.foam_source, "foam source", gpu::TexelFormat::kR32F, kScratch);
  if (create.error()) return *create.error();
  return p;
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
