#include "particle_pool.h"

#include <algorithm>

#include <shared/bindings.h>
#include <shared/groups.h>
#include <shared/pool.h>

#include "create_all.h"

namespace spindrift::sim {

core::Result<std::unique_ptr<ParticlePool>> ParticlePool::create(gpu::Context& ctx, const ParticleLayout& layout,
                                                                 const gpu::Defines& defines) {
  auto out = std::unique_ptr<ParticlePool>(new ParticlePool(ctx));
  Creation create;
  create(out->words_, gpu::TexelBuffer::create(ctx, "pool", POOL_WORDS, gpu::TexelFormat::kR32UI));
  create(out->emitters_, gpu::TexelBuffer::create(ctx, "emitters", layout.count, gpu::TexelFormat::kR32UI,
                                                  gpu::BufferContent::kScratch));
  create(out->plan_, gpu::Program::create(ctx, "coupling/plan.comp", defines));
  create(out->emit_, gpu::Program::create(ctx, "coupling/emit.comp", defines));
  if (create.error()) return *create.error();
  return out;
}

void ParticlePool::plan() {
  words_.bindStorage(POOL);
  plan_.dispatchGroups(1);
  ctx_.barrier(gpu::Barrier::kStorageAndTexel | gpu::Barrier::kIndirect);
}

void ParticlePool::emit(const ParticleBuffers& particles, Wave& wave, const gpu::TexelBuffer& breaking,
                        std::uint32_t tick) {
  words_.bindStorage(POOL);
  wave.bindSurface();
  wave.bindTerrain();
  wave.bindBasin();
  breaking.bindTexel(BREAKING);
  emitters_.bindTexel(EMITTER);
  particles.position.bindStorage(POSITION);
  particles.velocity.bindStorage(VELOCITY);
  wave.elevation().bindStorage(ELEVATION);
  emit_.setUniform("tick", tick);
  emit_.dispatchIndirect(words_, POOL_EMIT_ARGS * 4);
  ctx_.barrier(gpu::Barrier::kStorageAndTexel | gpu::Barrier::kIndirect);
}

void Population::forParticles(gpu::Program& program) const {
  if (pool_)
    program.dispatchIndirect(pool_->words(), POOL_PARTICLE_ARGS * 4);
  else
    program.dispatch(count_);
}

void Population::forCells(gpu::Program& program) const {
  if (pool_)
    program.dispatchIndirect(pool_->words(), POOL_CELL_ARGS * 4);
  else
    program.dispatchGroups(std::min<std::uint32_t>(cell_count_ / program.groupSize()[0] + 1, MAX_GROUPS));
}

void Population::forScanBlocks(gpu::Program& program) const {
  if (pool_)
    program.dispatchIndirect(pool_->words(), POOL_BLOCK_ARGS * 4);
  else
    program.dispatchGroups(cell_count_ / SCAN_BLOCK + 1);
}

void Population::forOneGroup(gpu::Program& program) const {
  if (pool_)
    program.dispatchIndirect(pool_->words(), POOL_ONE_ARGS * 4);
  else
    program.dispatchGroups(1);
}

void Population::bind() const {
  if (!pool_) return;
  pool_->words().bindTexel(POOL);
  pool_->words().bindStorage(POOL);
}

}  // namespace spindrift::sim
