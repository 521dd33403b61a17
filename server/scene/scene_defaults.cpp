// Scene messages made complete, and made fit to send.
#include <spindrift/scene/fields.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/scene/setting.h>

namespace spindrift::scene {

void fillDefaults(v1::Scene& scene) {
  scene.mutable_stream();
  if (scene.seed() == 0) scene.set_seed(core::Scene{}.seed);
  // Enums whose defaults depend on other fields: absorption, and the setting below, which needs the numbers filled in.
  if (scene.has_wave() && scene.wave().absorption() == v1::ABSORPTION_UNSPECIFIED) {
    const bool nine = scene.wave().stencil() == v1::STENCIL_NINE_POINT;
    scene.mutable_wave()->set_absorption(nine ? v1::ABSORPTION_SPONGE : v1::ABSORPTION_PML);
  }
  const v1::Setting named = scene.setting();
  fillMessageDefaults(scene);
  scene.set_setting(named);
  scene.set_setting(settingOf(scene));
}

v1::Scene forClients(const v1::Scene& scene) {
  v1::Scene out = scene;
  if (out.bed().has_grid()) out.mutable_bed()->mutable_grid()->clear_points();
  for (v1::WaveMaker& maker : *out.mutable_wave_makers()) {
    if (!maker.has_series()) continue;
    maker.mutable_series()->clear_time_s();
    maker.mutable_series()->clear_elevation_m();
  }
  return out;
}

}  // namespace spindrift::scene
