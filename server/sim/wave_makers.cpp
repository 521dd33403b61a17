#include "wave_makers.h"

#include <shared/bindings.h>
#include <shared/maker_uniforms.h>

#include <spindrift/sim_setup/scene_parts.h>

namespace spindrift::sim {

WaveMakers::WaveMakers(Creation& create, const core::Scene& scene, const WaveLayout& layout)
    : count_(layout.counts()), pass_(create.pass("wave/maker.comp")) {
  for (const core::WaveMaker& maker : scene.wave_makers)
    makers_.push_back({maker.side, {}, create.uniforms<shared::MakerUniforms>("wave maker")});
  update(scene, layout);
}

void WaveMakers::update(const core::Scene& scene, const WaveLayout& layout) {
  const Inputs inputs{
      .depth_m = scene.wave->depth_m, .gravity_mps2 = scene.gravity_mps2, .dt_s = layout.dt_s, .seed = scene.seed};
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
    pass_.run(is_x ? count_.z : count_.x);  // one after the other: makers of two sides share a corner
  }
}

}  // namespace spindrift::sim
