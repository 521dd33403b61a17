// Scene messages made complete, made fit to send, and converted as far as generated code (scene_types.py) does not:
// depths of a grid, and a limit.
#include <cstring>
#include <memory>

#include <spindrift/scene/fields.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/scene/to_core.h>

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

core::DepthGrid toCore(const v1::DepthGrid& in) {
  core::DepthGrid out;
  out.x_m = in.x_m();
  out.z_m = in.z_m();
  out.length_m = in.length_m();
  out.width_m = in.width_m();
  const std::size_t row_bytes = in.points_size() > 0 ? in.points(0).size() : 0;
  out.columns_count = static_cast<std::uint32_t>(row_bytes / sizeof(float));
  out.rows_count = static_cast<std::uint32_t>(in.points_size());
  // derive() refuses a grid whose rows differ: it has fewer depths than points.
  std::vector<float> depths_m;
  for (const std::string& row : in.points()) {
    if (row.size() != row_bytes) break;
    const std::size_t before = depths_m.size();
    depths_m.resize(before + out.columns_count);
    std::memcpy(depths_m.data() + before, row.data(), out.columns_count * sizeof(float));
  }
  out.depths_m = std::make_shared<const std::vector<float>>(std::move(depths_m));
  return out;
}

core::Scene toCore(const v1::Scene& in) {
  core::Scene out = fieldsToCore(in);
  // Below this, waves need hours to cross any water, and numbers that follow from their speed leave the range of
  // floats.
  constexpr double kLeastGravity_mps2 = 1e-6;
  if (out.gravity_mps2 < kLeastGravity_mps2) out.gravity_mps2 = 0.0;
  return out;
}

}  // namespace spindrift::scene
