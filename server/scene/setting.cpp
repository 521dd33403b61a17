#include <algorithm>

#include <spindrift/scene/scene_loader.h>
#include <spindrift/scene/scene_rules.h>

namespace spindrift::scene {
namespace {

/// Water that is at least this many times as long as wide is a flume.
constexpr double kFlumeAspect = 2.0;
/// Walled water with sides up to this length is in a glass tank, larger water in a pool; a channel up to this wide is a
/// flume. [m]
constexpr double kTankMaxSide_m = 6.0;

bool isPeriodic(v1::WaveBoundary side) {
  return side == v1::WAVE_BOUNDARY_UNSPECIFIED || side == v1::WAVE_BOUNDARY_PERIODIC;
}

bool isWall(v1::WaveBoundary side) {
  return side == v1::WAVE_BOUNDARY_REFLECT;
}

bool isPeriodic(v1::Boundary side) {
  return side == v1::BOUNDARY_UNSPECIFIED || side == v1::BOUNDARY_PERIODIC;
}

v1::Setting walledSetting(double side_m) {
  return side_m <= kTankMaxSide_m ? v1::SETTING_GLASS_TANK : v1::SETTING_POOL;
}

v1::Setting ofWave(const v1::WaveScene& wave) {
  const core::WaveCells cells = waveCellsOf(wave);
  const double longer_m = std::max(cells.length_m, cells.width_m);
  const double shorter_m = std::min(cells.length_m, cells.width_m);
  // Walls along a narrow channel, whatever its ends are.
  const bool has_long_walls =
      longer_m >= kFlumeAspect * shorter_m && shorter_m <= kTankMaxSide_m &&
      (cells.length_m > cells.width_m ? isWall(wave.boundary_minus_z()) && isWall(wave.boundary_plus_z())
                                      : isWall(wave.boundary_minus_x()) && isWall(wave.boundary_plus_x()));
  if (has_long_walls) return v1::SETTING_FLUME;
  const auto absorbs = [](v1::WaveBoundary side) { return side == v1::WAVE_BOUNDARY_ABSORB; };
  if (absorbs(wave.boundary_minus_x()) || absorbs(wave.boundary_plus_x()) || absorbs(wave.boundary_minus_z()) ||
      absorbs(wave.boundary_plus_z()))
    return v1::SETTING_OPEN_SEA;
  const bool is_periodic_x = isPeriodic(wave.boundary_minus_x());
  const bool is_periodic_z = isPeriodic(wave.boundary_minus_z());
  if (is_periodic_x && is_periodic_z) return v1::SETTING_OPEN_SEA;
  // Walls at two ends only: the waves do not depend on the width, as in a flume.
  if (is_periodic_x != is_periodic_z) return v1::SETTING_FLUME;
  return walledSetting(longer_m);
}

v1::Setting ofBox(const v1::Scene& scene) {
  const v1::ParticleScene& box = scene.particles();
  const WaterExtents water = waterExtentsOf(scene);
  const double longer_m = water.side_x_m + water.side_z_m - water.shorterSide_m();
  if (isPeriodic(box.boundary_x()) != isPeriodic(box.boundary_z())) return v1::SETTING_FLUME;
  if (longer_m >= kFlumeAspect * water.shorterSide_m()) return v1::SETTING_FLUME;
  return walledSetting(longer_m);
}

}  // namespace

v1::Setting settingOf(const v1::Scene& scene) {
  if (scene.setting() != v1::SETTING_UNSPECIFIED) return scene.setting();
  return scene.has_wave() ? ofWave(scene.wave()) : ofBox(scene);
}

std::string settingName(v1::Setting setting) {
  std::string name = v1::Setting_Name(setting).substr(sizeof "SETTING_" - 1);
  std::ranges::transform(name, name.begin(), [](char c) { return c == '_' ? ' ' : static_cast<char>(c - 'A' + 'a'); });
  return name;
}

}  // namespace spindrift::scene
