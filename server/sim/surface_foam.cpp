#include "surface_foam.h"

#include <shared/bindings.h>

#include "create_all.h"

namespace spindrift::sim {

core::Result<std::unique_ptr<SurfaceFoam>> SurfaceFoam::create(gpu::Context& ctx, const core::Scene& scene,
                                                               const WaveLayout& layout, const gpu::Defines& defines) {
  auto out = std::unique_ptr<SurfaceFoam>(new SurfaceFoam(ctx, layout));
  out->has_landings_ = scene.coupling && scene.coupling->mode == core::CouplingMode::kTwoWay;
  const std::size_t cells = out->count_.total();
  Creation create;
  create(out->now_, gpu::TexelBuffer::create(ctx, "foam", cells, gpu::TexelFormat::kRGBA32F));
  create(out->before_,
         gpu::TexelBuffer::create(ctx, "foam before", cells, gpu::TexelFormat::kRGBA32F, gpu::BufferContent::kScratch));
  if (out->has_landings_)
    create(out->landed_, gpu::TexelBuffer::create(ctx, "landed", cells, gpu::TexelFormat::kR32UI));
  create(out->advance_, gpu::Program::create(ctx, "foam/advance.comp", defines));
  if (create.error()) return *create.error();
  return out;
}

void SurfaceFoam::clear() {
  now_.clear();
  before_.clear();
  if (has_landings_) landed_.clear();
}

void SurfaceFoam::declareState(StateBuffers& out) {
  out.push_back({.buffer = &now_, .checkpoint = true, .carried = true});
  if (has_landings_) out.push_back({.buffer = &landed_});
}

void SurfaceFoam::advance(const Wave& wave, Breakers& breakers, const Boats* boats) {
  before_.copyFrom(now_, 0, now_.sizeBytes());
  wave.bindSurface();
  breakers.state().bindTexel(BREAKING);
  before_.bindTexel(FOAM_BEFORE);
  now_.bindStorage(FOAM_FIELD);
  if (has_landings_) landed_.bindStorage(LANDED);
  if (boats) boats->bind();
  advance_.dispatch(count_.x, count_.z);
  ctx_.barrier(gpu::Barrier::kStorageAndTexel);
}

}  // namespace spindrift::sim
