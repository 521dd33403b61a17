// Scene messages made complete, made fit to send, and converted as far as generated code (scene_types.py) does not:
// depths of a grid, and a limit.
#include <algorithm>
#include <array>
#include <cstring>
#include <memory>

#include <spindrift/scene/fields.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/scene/scene_rules.h>
#include <spindrift/scene/to_core.h>

namespace spindrift::scene {
namespace {

/// Water that is at least this many times as long as wide is a flume.
constexpr double kFlumeAspect = 2.0;
/// Walled water with sides up to this length is in a glass tank, larger water in a pool; a channel up to this wide is a
/// flume. [m]
constexpr double kTankMaxSide_m = 6.0;

v1::Setting walledSetting(double side_m) {
  return side_m <= kTankMaxSide_m ? v1::SETTING_GLASS_TANK : v1::SETTING_POOL;
}

/// Where the water is, as it follows from sides and parts. Precondition: the defaults are filled in.
v1::Setting ofWave(const v1::WaveScene& wave) {
  const core::WaveCells cells = waveCellsOf(wave);
  const double longer_m = std::max(cells.length_m, cells.width_m);
  const double shorter_m = std::min(cells.length_m, cells.width_m);
  const std::array along_x{wave.boundary_minus_x(), wave.boundary_plus_x()};  // the ends of this axis
  const std::array along_z{wave.boundary_minus_z(), wave.boundary_plus_z()};
  // Walls along a narrow channel, whatever its ends are.
  const auto& long_sides = cells.length_m > cells.width_m ? along_z : along_x;
  if (longer_m >= kFlumeAspect * shorter_m && shorter_m <= kTankMaxSide_m &&
      std::ranges::count(long_sides, v1::WAVE_BOUNDARY_REFLECT) == 2)
    return v1::SETTING_FLUME;
  if (std::ranges::count(along_x, v1::WAVE_BOUNDARY_ABSORB) + std::ranges::count(along_z, v1::WAVE_BOUNDARY_ABSORB) > 0)
    return v1::SETTING_OPEN_SEA;
  const bool is_periodic_x = along_x[0] == v1::WAVE_BOUNDARY_PERIODIC;
  const bool is_periodic_z = along_z[0] == v1::WAVE_BOUNDARY_PERIODIC;
  if (is_periodic_x && is_periodic_z) return v1::SETTING_OPEN_SEA;
  // Walls at two ends only: the waves do not depend on the width, as in a flume.
  if (is_periodic_x != is_periodic_z) return v1::SETTING_FLUME;
  return walledSetting(longer_m);
}

v1::Setting ofBox(const v1::Scene& scene) {
  const v1::ParticleScene& box = scene.particles();
  const WaterExtents water = waterExtentsOf(scene);
  const double longer_m = water.side_x_m + water.side_z_m - water.shorterSide_m();
  const bool is_periodic_x = box.boundary_x() == v1::BOUNDARY_PERIODIC;
  if (is_periodic_x != (box.boundary_z() == v1::BOUNDARY_PERIODIC)) return v1::SETTING_FLUME;
  if (longer_m >= kFlumeAspect * water.shorterSide_m()) return v1::SETTING_FLUME;
  return walledSetting(longer_m);
}

/// The optics of the water, as they follow from what is around it. Precondition: the setting is known.
v1::WaterType waterTypeOf(const v1::Scene& scene) {
  if (scene.setting() != v1::SETTING_OPEN_SEA) return v1::WATER_TYPE_POOL;
  const bool has_ground = scene.beaches_size() > 0 || scene.obstacles_size() > 0 || scene.has_bed();
  return has_ground ? v1::WATER_TYPE_COAST : v1::WATER_TYPE_OCEAN;
}

}  // namespace

void fillDefaults(v1::Scene& scene) {
  scene.mutable_stream();
  if (scene.seed() == 0) scene.set_seed(core::Scene{}.seed);
  // Enums whose defaults depend on other fields: absorption, and setting and water type below, which
  // need the numbers filled in.
  if (scene.has_wave() && scene.wave().absorption() == v1::ABSORPTION_UNSPECIFIED) {
    const bool nine = scene.wave().stencil() == v1::STENCIL_NINE_POINT;
    scene.mutable_wave()->set_absorption(nine ? v1::ABSORPTION_SPONGE : v1::ABSORPTION_PML);
  }
  const v1::Setting named = scene.setting();
  const v1::WaterType named_type = scene.water_type();
  const v1::Unwatched unwatched = scene.unwatched();  // unspecified is a choice of its own
  fillMessageDefaults(scene);
  scene.set_unwatched(unwatched);
  scene.set_setting(named != v1::SETTING_UNSPECIFIED ? named : scene.has_wave() ? ofWave(scene.wave()) : ofBox(scene));
  scene.set_water_type(named_type != v1::WATER_TYPE_UNSPECIFIED ? named_type : waterTypeOf(scene));
}

std::string settingName(v1::Setting setting) {
  std::string name = v1::Setting_Name(setting).substr(sizeof "SETTING_" - 1);
  std::ranges::transform(name, name.begin(), [](char c) { return c == '_' ? ' ' : static_cast<char>(c - 'A' + 'a'); });
  return name;
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
