#include "particle_pool.h"

#include <algorithm>

#include <shared/bindings.h>
#include <shared/groups.h>
#include <shared/pool.h>

#include <spindrift/sim_setup/scene_parts.h>

namespace spindrift::sim {
namespace {

/// One buffer of the pool holds both the group counts of the next pass and words that passes write.
constexpr gpu::Barrier kPoolReaders = gpu::Barrier::kStorageAndTexel | gpu::Barrier::kIndirect;

}  // namespace

ParticlePool::ParticlePool(Creation& create, const core::Scene& scene, const Derived& derived)
    : wave_count_(derived.wave->counts()),
      words_(create.texels("pool", POOL_WORDS, gpu::TexelFormat::kR32UI)),
      emitters_(create.scratch("emitters", derived.particles->count, gpu::TexelFormat::kR32UI)),
      plan_(create.pass("coupling/plan.comp")),
      emit_(create.pass("coupling/emit.comp")) {
  if (!isNonlinear(scene)) return;
  landed_ = create.texels("landed water", LANDED_WORDS * wave_count_.total(), gpu::TexelFormat::kR32I);
  mix_ = create.pass("coupling/mix.comp");
}

void ParticlePool::declareState(StateBuffers& out) {
  out.push_back({.buffer = &words_, .checkpoint = true, .carried = true});
  if (landed_) out.push_back({.buffer = &landed_, .lasts = false});
}

void ParticlePool::plan() {
  words_.bindStorage(POOL);
  plan_.dispatchGroups(1);
  plan_.barrier(kPoolReaders);
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
  emit_.barrier(kPoolReaders);
}

void ParticlePool::bindLanded() const {
  if (landed_) landed_.bindStorage(LANDED_WATER);
}

void ParticlePool::mix(Wave& wave) {
  wave.bindBasin();
  wave.elevation().bindTexel(ELEVATION);
  wave.flow().bindStorage(FLOW);
  landed_.bindTexel(LANDED_WATER);
  mix_.runStrips(wave_count_);
  landed_.clear();
}

void Population::run(Pass& pass, std::size_t arguments, std::uint32_t group_count) const {
  bind();
  if (pool_)
    pass.dispatchIndirect(pool_->words(), arguments * 4);
  else
    pass.dispatchGroups(group_count);
  pass.barrier(pool_ ? kPoolReaders : gpu::Barrier::kStorageAndTexel);
}

void Population::forParticles(Pass& pass) const {
  const std::uint32_t group = pass.groupSize()[0];
  run(pass, POOL_PARTICLE_ARGS, (count_ + group - 1) / group);
}

void Population::forScanRuns(Pass& pass, std::uint32_t run_count) const {
  const std::uint32_t group = pass.groupSize()[0];
  run(pass, POOL_BLOCK_ARGS, std::min<std::uint32_t>((run_count + group - 1) / group, MAX_GROUPS));
}

void Population::forOneGroup(Pass& pass) const {
  run(pass, POOL_ONE_ARGS, 1);
}

void Population::bind() const {
  if (!pool_) return;
  pool_->words().bindTexel(POOL);
  pool_->words().bindStorage(POOL);
}

}  // namespace spindrift::sim
