#include "breakers.h"

#include <shared/bindings.h>

namespace spindrift::sim {

Breakers::Breakers(Creation& create, const WaveLayout& layout)
    : count_(layout.counts()),
      now_(create.texels("breaking", count_.total(), gpu::TexelFormat::kRGBA32F)),
      before_(create.scratch("breaking before", count_.total(), gpu::TexelFormat::kRGBA32F)),
      pass_(create.pass("wave/breaking.comp")) {}

void Breakers::clear() {
  now_.clear();
  before_.clear();
}

void Breakers::update(const Wave& wave, const ParticlePool* pool, std::uint32_t tick) {
  // The current state always stays in the same buffer, so that checkpoints and readers use a fixed one.
  before_.copyFrom(now_, 0, now_.sizeBytes());
  now_.clear();
  wave.bindSurface();
  wave.bindBasin();
  wave.bindEvents();
  before_.bindTexel(BREAKING_BEFORE);
  now_.bindStorage(BREAKING);
  if (pool) {
    wave.bindTerrain();
    pool->words().bindStorage(POOL);
    pool->emitters().bindStorage(EMITTER);
    pass_.setUniform("tick", tick);
  }
  pass_.runStrips(count_);
}

}  // namespace spindrift::sim
