#include "wave_makers.h"

#include <utility>

#include <shared/bindings.h>

#include <spindrift/sim_setup/scene_parts.h>

#include "create_all.h"

namespace spindrift::sim {

core::Result<std::unique_ptr<WaveMakers>> WaveMakers::create(gpu::Context& ctx, const core::Scene& scene,
                                                             const WaveLayout& layout, const gpu::Defines& defines) {
  auto out = std::unique_ptr<WaveMakers>(new WaveMakers(ctx));
  out->count_ = layout.counts();
  Creation create;
  create(out->program_, gpu::Program::create(ctx, "wave/maker.comp", defines));
  for (const core::WaveMaker& maker : scene.wave_makers) {
    Maker& made = out->makers_.emplace_back();
    made.side = maker.side;
    create(made.uniforms,
           gpu::Buffer::create(ctx, "wave maker", sizeof(shared::MakerUniforms), gpu::BufferUse::kUpdatable));
  }
  if (create.error()) return *create.error();
  out->update(scene, layout);
  return out;
}

void WaveMakers::update(const core::Scene& scene, const WaveLayout& layout) {
  const Inputs inputs{.depth_m = scene.wave->depth_m, .gravity_mps2 = scene.gravity_mps2, .dt_s = layout.dt_s};
  if (inputs == inputs_) return;
  inputs_ = inputs;
  for (std::size_t k = 0; k < makers_.size(); ++k) {
    const core::WaveMaker& maker = scene.wave_makers[k];
    makers_[k].waves = IncidentWaves::of(maker, scene, layout, depthAtSide(scene, layout, maker.side));
  }
}

void WaveMakers::advance(double middle_s) {
  for (Maker& maker : makers_) {
    const Incident incident = maker.waves.at(middle_s);
    const auto f = [](double v) { return static_cast<float>(v); };
    maker.uniforms.uploadValue(shared::MakerUniforms{.maker_side = makerBit(maker.side),
                                                     .maker_flow_m2ps = f(incident.flow_m2ps),
                                                     .maker_elevation_m = f(incident.elevation_m),
                                                     .maker_absorbing_mps = f(maker.waves.absorbing_mps()),
                                                     .maker_depth_m = f(maker.waves.depth_m()),
                                                     .unused = {}});
    maker.uniforms.bindUniform(MAKER_UNIFORMS);
    const bool is_x = maker.side == core::Side::kMinusX || maker.side == core::Side::kPlusX;
    program_.dispatch(is_x ? count_.z : count_.x);
    ctx_.barrier(gpu::Barrier::kStorageAndTexel);  // makers of two sides share a corner
  }
}

}  // namespace spindrift::sim
