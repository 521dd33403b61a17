#include "wave_layout.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include <fmt/format.h>

#include <spindrift/sim_setup/dispersion.h>
#include <spindrift/sim_setup/scene_parts.h>

namespace spindrift::sim {
namespace {

/// Stability limits of the leapfrog on a square grid: 1/sqrt(2), and sqrt(3)/2 for the isotropic 9-point stencil.
constexpr double kFivePointCourant = 0.70710678;
constexpr double kNinePointCourant = 0.8660254;
/// Share of the wave's stability limit that is used: a margin for rounding only.
constexpr double kWaveSafety = 0.98;
/// Share of a cell that a long wave may cross in a step of nonlinear shallow water. Its limit is 0.7 without flow; the
/// rest is for higher water and for the flow that carries waves: together 1.5 times as fast as still water.
constexpr double kShallowCourant = 0.45;
/// Nonlinear water has at most this depth, so that depth and elevation together fit their units.
constexpr double kShallowMaxDepth_m = 50.0;

using core::invalid;

/// Says which periodic side has a number of cells without grids for the dispersion, and which numbers have some.
std::string whyNoGrids(const WaveLayout& layout) {
  const auto hasGrids = [&](bool along_x, std::uint32_t count) {
    WaveLayout alone = layout;
    (along_x ? alone.is_periodic_z : alone.is_periodic_x) = false;
    (along_x ? alone.count_x : alone.count_z) = count;
    return canDisperse(alone);
  };
  for (const bool along_x : {true, false}) {
    const std::uint32_t count = along_x ? layout.count_x : layout.count_z;
    if (hasGrids(along_x, count)) continue;
    std::uint32_t fewer = count, more = count;
    while (fewer > 1 && !hasGrids(along_x, fewer)) --fewer;
    while (!hasGrids(along_x, more)) ++more;
    return fmt::format(
        "wave.resolution_count: {} cells along {} between periodic sides cannot be halved often enough for "
        "DISPERSION_AIRY: use {} or {}, or sides that are not periodic",
        count, along_x ? "x" : "z", fewer, more);
  }
  return fmt::format(
      "wave.resolution_count: {} x {} cells between periodic sides cannot be halved often enough for DISPERSION_AIRY: "
      "use powers of two",
      layout.count_x, layout.count_z);
}

}  // namespace

core::Result<WaveLayout> layOutWave(const core::Scene& scene) {
  const core::WaveScene& w = *scene.wave;
  const core::WaveCells cells = core::waveCellsOf(w);
  if (!core::widthFits(cells, w.width_m))
    return invalid(
        fmt::format("wave.width_m: {:.6g} m is not a whole number of the cells of {:.6g} m that side_m and "
                    "resolution_count make: use "
                    "{:.6g} or {:.6g} m, or another resolution_count",
                    w.width_m, cells.cell_m, std::max(std::floor(w.width_m / cells.cell_m), 1.0) * cells.cell_m,
                    (std::floor(w.width_m / cells.cell_m) + 1) * cells.cell_m));
  if (cells.count.z > core::kWaveMaxSideCount || cells.count.total() > core::kWaveMaxCellCount)
    return invalid(fmt::format(
        "wave.resolution_count: {} x {} cells are more than {} along an axis or {} in all: use fewer, or a smaller "
        "width_m",
        cells.count.x, cells.count.z, core::kWaveMaxSideCount, core::kWaveMaxCellCount));
  WaveLayout out;
  out.count_x = cells.count.x;
  out.count_z = cells.count.z;
  out.length_m = cells.length_m;
  out.width_m = cells.width_m;
  out.cell_m = cells.cell_m;
  out.is_periodic_x = isPeriodicX(w);
  out.is_periodic_z = isPeriodicZ(w);
  if (disperses(scene)) {
    if (w.stencil == core::Stencil::kNinePoint)
      return invalid("wave.dispersion: DISPERSION_AIRY needs STENCIL_FIVE_POINT; remove wave.stencil");
    if (!canDisperse(out)) return invalid(whyNoGrids(out));
  }
  if (isNonlinear(scene)) {
    if (w.stencil == core::Stencil::kNinePoint)
      return invalid("wave.bulk: BULK_NONLINEAR needs STENCIL_FIVE_POINT; remove wave.stencil");
    if (w.steepening_ratio > 0)
      return invalid(
          fmt::format("wave.steepening_ratio: {} is for BULK_LINEAR; BULK_NONLINEAR steepens by itself: remove it",
                      w.steepening_ratio));
    if (w.depth_m > kShallowMaxDepth_m)
      return invalid(
          fmt::format("wave.depth_m: {} m; BULK_NONLINEAR takes at most {} m: use shallower water or BULK_LINEAR",
                      w.depth_m, kShallowMaxDepth_m));
  }
  if (hasMatchedLayer(scene) && w.stencil == core::Stencil::kNinePoint)
    return invalid(
        "wave.absorption: ABSORPTION_PML needs STENCIL_FIVE_POINT; remove wave.stencil or choose ABSORPTION_SPONGE");
  out.speed_mps = std::sqrt(scene.gravity_mps2 * w.depth_m);
  if (disperses(scene)) out.dispersing_depth_m = w.depth_m;
  return out;
}

/// Holds in sponges and with any damping, too, because losses are centred in the step (shaders/wave/continuity.comp).
double waveMaxStep(const core::Scene& scene, const WaveLayout& layout) {
  const core::WaveScene& wave = *scene.wave;
  double deepest_m = wave.depth_m;
  for (const core::Beach& beach : scene.beaches) deepest_m = std::max(deepest_m, beach.shore_depth_m);
  if (isNonlinear(scene)) {
    return kShallowCourant * layout.cell_m / std::sqrt(std::max(scene.gravity_mps2 * deepest_m, 1e-18));
  }
  if (disperses(scene)) {
    // A crest's factor on the slope (see below) may act on all of the waves.
    return dispersedMaxStep(scene.gravity_mps2, deepest_m, layout.cell_m) / std::sqrt(1.0 + wave.steepening_ratio);
  }
  const double limit = wave.stencil == core::Stencil::kNinePoint ? kNinePointCourant : kFivePointCourant;
  // Crests of a steepening wave are faster: shaders/wave/momentum.comp bounds d (1 + 3 s eta/d) by d (1 + s).
  const double fastest_mps = layout.speed_mps * std::sqrt(1.0 + wave.steepening_ratio);
  return fastest_mps > 0 ? kWaveSafety * limit * layout.cell_m / fastest_mps : 1e9;
}

std::string waveRule(const core::Scene& scene) {
  if (isNonlinear(scene)) return fmt::format("nonlinear wave CFL, {} dx / c", kShallowCourant);
  const bool steepens = scene.wave->steepening_ratio > 0;
  if (disperses(scene))
    return std::string("wave step with dispersion, 1.8 / (highest frequency of the grid") +
           (steepens ? ", times sqrt(1 + steepening))" : ")");
  const std::string limit = scene.wave->stencil == core::Stencil::kNinePoint ? "0.849" : "0.693";
  return "wave CFL, " + limit + " dx / " + (steepens ? "(c sqrt(1 + steepening))" : "c");
}

}  // namespace spindrift::sim
