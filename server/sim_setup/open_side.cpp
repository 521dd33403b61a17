#include <algorithm>
#include <array>

#include <spindrift/sim_setup/ground.h>
#include <spindrift/sim_setup/open_side.h>

namespace spindrift::sim {
namespace {

/// The water along a side is judged by so many positions, from the side to this share of the way across, where crests
/// start.
constexpr int kPlacesAlong = 32;
constexpr int kPlacesAcross = 8;
constexpr double kJudgedShare = 0.25;
/// Sides whose depths differ by less than this share of the water's depth are equally deep.
constexpr double kEqualShare = 0.05;

struct SideWater {
  core::Side side = core::Side::kPlusX;
  core::WaveBoundary boundary = core::WaveBoundary::kPeriodic;
  /// From the centre toward the side.
  double x = 0.0;
  double z = 0.0;
};

double meanDepth(const core::Scene& scene, const SideWater& at) {
  const core::WaveCells water = core::waveCellsOf(*scene.wave);
  double sum_m = 0.0;
  for (int across = 0; across < kPlacesAcross; ++across) {
    // In half lengths from the centre: 1 at the side.
    const double outward = 1.0 - 2.0 * kJudgedShare * (across + 0.5) / kPlacesAcross;
    for (int along = 0; along < kPlacesAlong; ++along) {
      const double sideward = 2.0 * (along + 0.5) / kPlacesAlong - 1.0;
      const double x_m = 0.5 * water.length_m * (at.x != 0.0 ? at.x * outward : sideward);
      const double z_m = 0.5 * water.width_m * (at.z != 0.0 ? at.z * outward : sideward);
      sum_m += std::max(groundDepthWithObstacles(scene, x_m, z_m), 0.0);
    }
  }
  return sum_m / (kPlacesAlong * kPlacesAcross);
}

}  // namespace

core::Side openSide(const core::Scene& scene) {
  if (!scene.wave) return core::Side::kPlusX;
  const core::WaveScene& wave = *scene.wave;
  const std::array<SideWater, 4> sides{{{core::Side::kPlusX, wave.boundary_plus_x, 1, 0},
                                        {core::Side::kMinusX, wave.boundary_minus_x, -1, 0},
                                        {core::Side::kPlusZ, wave.boundary_plus_z, 0, 1},
                                        {core::Side::kMinusZ, wave.boundary_minus_z, 0, -1}}};
  std::array<double, sides.size()> depths_m{};
  std::ranges::transform(sides, depths_m.begin(), [&](const SideWater& at) { return meanDepth(scene, at); });
  const double least_m = std::ranges::max(depths_m) - kEqualShare * wave.depth_m;
  const SideWater* chosen = nullptr;
  for (std::size_t k = 0; k < sides.size(); ++k) {
    const bool is_open = sides[k].boundary == core::WaveBoundary::kAbsorb;
    if (depths_m[k] < least_m || (chosen && (!is_open || chosen->boundary == core::WaveBoundary::kAbsorb))) continue;
    chosen = &sides[k];
  }
  return chosen->side;
}

}  // namespace spindrift::sim
