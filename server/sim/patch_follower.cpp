#include "patch_follower.h"

#include <shared/bindings.h>

namespace spindrift::sim {

PatchFollower::PatchFollower(Creation& create, const core::Scene& scene)
    : water_(core::waveCellsOf(*scene.wave)),
      x_m_(scene.particles->patch_shift_x_m),
      z_m_(scene.particles->patch_shift_z_m),
      pass_(create.pass("coupling/follow.comp")) {}

void PatchFollower::goTo(double x_m, double z_m) {
  x_m_ = x_m;
  z_m_ = z_m;
}

void PatchFollower::move(const gpu::Buffer& sim_uniforms, const Boats* boats) {
  if (boats) boats->bind();
  sim_uniforms.bindStorage(SIM_UNIFORMS_STORAGE);
  pass_.setUniform("wave_length_m", static_cast<float>(water_.length_m));
  pass_.setUniform("wave_width_m", static_cast<float>(water_.width_m));
  pass_.setUniform("place_x_m", static_cast<float>(x_m_));
  pass_.setUniform("place_z_m", static_cast<float>(z_m_));
  pass_.dispatchGroups(1);
  pass_.barrier(gpu::Barrier::kUniform | gpu::Barrier::kStorageAndTexel);
}

}  // namespace spindrift::sim
