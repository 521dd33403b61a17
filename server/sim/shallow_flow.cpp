#include "shallow_flow.h"

#include <string>
#include <utility>

#include <shared/bindings.h>

#include <spindrift/sim_setup/scene_parts.h>

#include "create_all.h"

namespace spindrift::sim {

core::Result<std::unique_ptr<ShallowFlow>> ShallowFlow::create(gpu::Context& ctx, const core::Scene& scene,
                                                               const WaveLayout& layout, const gpu::Defines& defines) {
  using gpu::TexelBuffer;
  auto out = std::unique_ptr<ShallowFlow>(new ShallowFlow(ctx, layout));
  const std::size_t cells = layout.counts().total();
  Creation create;
  create(out->next_flow_, TexelBuffer::create(ctx, "flow", cells, gpu::TexelFormat::kRGBA32F));
  for (const bool sea : {false, true}) {
    if (sea && !hasWindSea(scene)) continue;
    gpu::Defines of_sea = defines;
    of_sea.emplace_back("SEA", sea ? "1" : "0");
    create(out->momentum_[sea], gpu::Program::create(ctx, "wave/shallow_momentum.comp", of_sea));
  }
  if (disperses(scene)) {
    create(out->rise_,
           TexelBuffer::create(ctx, "surface rise", cells, gpu::TexelFormat::kRG32F, gpu::BufferContent::kScratch));
    create(out->slope_, gpu::Program::create(ctx, "wave/shallow_slope.comp", defines));
  }
  if (create.error()) return *create.error();
  return out;
}

void ShallowFlow::declareState(StateBuffers& out) {
  // Each step overwrites it, then it takes the place of the caller's flow, and its name.
  out.push_back({.buffer = &next_flow_, .lasts = false});
}

const gpu::TexelBuffer& ShallowFlow::findRise() {
  rise_.bindStorage(SURFACE_RISE);
  slope_.dispatch(count_.x, count_.z);
  ctx_.barrier(gpu::Barrier::kStorageAndTexel);
  return rise_;
}

void ShallowFlow::advance(gpu::TexelBuffer& flow, bool sea) {
  flow.bindTexel(FLOW);
  next_flow_.bindStorage(FLOW);
  momentum_[sea].dispatch(count_.x, count_.z);
  ctx_.barrier(gpu::Barrier::kStorageAndTexel);
  std::swap(flow, next_flow_);
}

}  // namespace spindrift::sim
