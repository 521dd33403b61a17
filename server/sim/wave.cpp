#include "wave.h"

#include <utility>

#include <shared/bindings.h>

#include "create_all.h"

namespace spindrift::sim {

core::Result<std::unique_ptr<Wave>> Wave::create(gpu::Context& ctx, const WaveLayout& layout,
                                                 const gpu::Defines& defines, bool coupled) {
  auto wave = std::unique_ptr<Wave>(new Wave(ctx, layout));
  const std::size_t cells = std::size_t{layout.resolution_count} * layout.resolution_count;
  Creation create;
  for (auto& level : wave->level_)
    create(level, gpu::TexelBuffer::create(ctx, "elevation", cells, gpu::TexelFormat::kR32F));
  create(wave->event_uniforms_, gpu::Buffer::create(ctx, "event uniforms", sizeof(shared::EventUniforms)));
  create(wave->inject_, gpu::Program::create(ctx, "wave/inject.comp", defines));
  create(wave->evolve_, gpu::Program::create(ctx, "wave/evolve.comp", defines));
  if (coupled) {
    create(wave->surface_, gpu::TexelBuffer::create(ctx, "surface", cells, gpu::TexelFormat::kRGBA32F));
    create(wave->flow_, gpu::TexelBuffer::create(ctx, "surface flow", cells, gpu::TexelFormat::kRG32F));
    create(wave->sample_surface_, gpu::Program::create(ctx, "coupling/sample_surface.comp", defines));
  }
  if (create.error()) return *create.error();
  return wave;
}

void Wave::inject(const shared::EventUniforms& events) {
  event_uniforms_.uploadValue(events);
  event_uniforms_.bindUniform(EVENT_UNIFORMS);
  level_[1].bindStorage(ELEVATION);
  level_[0].bindStorage(ELEVATION_PREVIOUS);
  inject_.dispatch(n_, n_);
  ctx_.barrier(gpu::Barrier::kStorageAndTexel);
}

void Wave::evolve() {
  level_[0].bindTexel(ELEVATION_PREVIOUS);
  level_[1].bindTexel(ELEVATION);
  level_[2].bindStorage(ELEVATION_NEXT);
  evolve_.dispatch(n_, n_);
  ctx_.barrier(gpu::Barrier::kStorageAndTexel);
  std::swap(level_[0], level_[1]);
  std::swap(level_[1], level_[2]);
}

void Wave::sampleSurface() {
  level_[0].bindTexel(ELEVATION_PREVIOUS);
  level_[1].bindTexel(ELEVATION);
  surface_.bindStorage(SURFACE);
  flow_.bindStorage(SURFACE_FLOW);
  sample_surface_.dispatch(n_, n_);
  ctx_.barrier(gpu::Barrier::kStorageAndTexel);
}

void Wave::bindSurface() const {
  surface_.bindTexel(SURFACE);
  flow_.bindTexel(SURFACE_FLOW);
}

}  // namespace spindrift::sim
