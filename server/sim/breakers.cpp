#include "breakers.h"

#include <shared/bindings.h>

#include "create_all.h"

namespace spindrift::sim {

core::Result<std::unique_ptr<Breakers>> Breakers::create(gpu::Context& ctx, const WaveLayout& layout,
                                                         const gpu::Defines& defines) {
  auto out = std::unique_ptr<Breakers>(new Breakers(ctx, layout));
  const std::size_t cells = layout.counts().total();
  Creation create;
  create(out->now_, gpu::TexelBuffer::create(ctx, "breaking", cells, gpu::TexelFormat::kRGBA32F));
  create(out->before_, gpu::TexelBuffer::create(ctx, "breaking before", cells, gpu::TexelFormat::kRGBA32F,
                                                gpu::BufferContent::kScratch));
  create(out->program_, gpu::Program::create(ctx, "wave/breaking.comp", defines));
  if (create.error()) return *create.error();
  return out;
}

void Breakers::clear() {
  now_.clear();
  before_.clear();
}

void Breakers::update(const Wave& wave, const ParticlePool* pool, std::uint32_t tick) {
  // The current state always stays in the same buffer, so that checkpoints and readers use a fixed one.
  before_.copyFrom(now_, 0, now_.sizeBytes());
  wave.bindSurface();
  wave.bindBasin();
  wave.bindEvents();
  before_.bindTexel(BREAKING_BEFORE);
  now_.bindStorage(BREAKING);
  if (pool) {
    wave.bindTerrain();
    pool->words().bindStorage(POOL);
    pool->emitters().bindStorage(EMITTER);
    program_.setUniform("tick", tick);
  }
  program_.dispatch(count_.x, count_.z);
  ctx_.barrier(gpu::Barrier::kStorageAndTexel);
}

}  // namespace spindrift::sim
