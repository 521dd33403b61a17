#include "patch_follower.h"

#include <shared/bindings.h>

#include "create_all.h"

namespace spindrift::sim {

PatchFollower::PatchFollower(gpu::Context& ctx, const core::Scene& scene)
    : ctx_(ctx),
      length_m_(core::waveCellsOf(*scene.wave).length_m),
      width_m_(core::waveCellsOf(*scene.wave).width_m),
      x_m_(scene.particles->patch_shift_x_m),
      z_m_(scene.particles->patch_shift_z_m) {}

core::Result<std::unique_ptr<PatchFollower>> PatchFollower::create(gpu::Context& ctx, const core::Scene& scene,
                                                                   const gpu::Defines& defines) {
  auto out = std::unique_ptr<PatchFollower>(new PatchFollower(ctx, scene));
  Creation create;
  create(out->program_, gpu::Program::create(ctx, "coupling/follow.comp", defines));
  if (create.error()) return *create.error();
  return out;
}

void PatchFollower::goTo(double x_m, double z_m) {
  x_m_ = x_m;
  z_m_ = z_m;
}

void PatchFollower::move(const gpu::Buffer& sim_uniforms, const Boats* boats) {
  if (boats) boats->bind();
  sim_uniforms.bindStorage(SIM_UNIFORMS_STORAGE);
  program_.setUniform("wave_length_m", static_cast<float>(length_m_));
  program_.setUniform("wave_width_m", static_cast<float>(width_m_));
  program_.setUniform("place_x_m", static_cast<float>(x_m_));
  program_.setUniform("place_z_m", static_cast<float>(z_m_));
  program_.dispatchGroups(1);
  ctx_.barrier(gpu::Barrier::kUniform | gpu::Barrier::kStorageAndTexel);
}

}  // namespace spindrift::sim
