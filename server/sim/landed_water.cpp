#include "landed_water.h"

#include <shared/bindings.h>
#include <shared/pool.h>

#include "create_all.h"

namespace spindrift::sim {
core::Result<std::unique_ptr<LandedWater>> LandedWater::create(gpu::Context& ctx, const WaveLayout& layout,
                                                               const gpu::Defines& defines) {
  auto out = std::unique_ptr<LandedWater>(new LandedWater(ctx, layout));
  Creation create;
  create(out->landed_,
         gpu::Buffer::create(ctx, "landed water", LANDED_WORDS * sizeof(std::int32_t) * layout.counts().total()));
  create(out->mix_, gpu::Program::create(ctx, "coupling/mix.comp", defines));
  if (create.error()) return *create.error();
  return out;
}

void LandedWater::bind() const {
  landed_.bindStorage(LANDED_WATER);
}

void LandedWater::mix(Wave& wave) {
  wave.bindBasin();
  wave.elevation().bindTexel(ELEVATION);
  wave.flow().bindStorage(FLOW);
  bind();
  mix_.dispatch(count_.x, count_.z);
  ctx_.barrier(gpu::Barrier::kStorageAndTexel);
  clear();
}

}  // namespace spindrift::sim
