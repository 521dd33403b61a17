#include "surface_foam.h"

#include <shared/bindings.h>

#include <spindrift/sim_setup/scene_parts.h>

namespace spindrift::sim {

SurfaceFoam::SurfaceFoam(Creation& create, const core::Scene& scene, const WaveLayout& layout)
    : count_(layout.foamCounts()),
      now_(create.texels("foam", count_.total(), gpu::TexelFormat::kRGBA32F)),
      before_(create.scratch("foam before", count_.total(), gpu::TexelFormat::kRGBA32F)),
      advance_(create.pass("foam/advance.comp")) {
  if (isTwoWay(scene)) landed_ = create.texels("landed", count_.total(), gpu::TexelFormat::kR32UI);
}

void SurfaceFoam::clear() {
  now_.clear();
  before_.clear();
  if (landed_) landed_.clear();
}

void SurfaceFoam::declareState(StateBuffers& out) {
  out.push_back({.buffer = &now_, .checkpoint = true, .carried = true});
  if (landed_) out.push_back({.buffer = &landed_});
}

void SurfaceFoam::advance(const Wave& wave, Breakers& breakers, const Boats* boats) {
  before_.copyFrom(now_, 0, now_.sizeBytes());
  wave.bindSurface();
  breakers.state().bindTexel(BREAKING);
  before_.bindTexel(FOAM_BEFORE);
  now_.bindStorage(FOAM_FIELD);
  if (landed_) landed_.bindStorage(LANDED);
  if (boats) boats->bind();
  advance_.run(count_);
}

}  // namespace spindrift::sim
