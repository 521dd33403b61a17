#include <algorithm>
#include <cmath>
#include <numbers>

#include <shared/effects.h>
#include <shared/side_bits.h>

#include <spindrift/core/parallel.h>
#include <spindrift/sim_setup/basin.h>
#include <spindrift/sim_setup/fill_up.h>
#include <spindrift/sim_setup/ground.h>

namespace spindrift::sim {
namespace {

using core::WaveBoundary;

/// The wave treats water shallower than this share of the scene's depth as dry ground.
constexpr double kDryShare = 0.03;
/// On a beach the wave's flow is damped where the depth is below this share of the scene's depth. Breaking is not
/// modelled there.
constexpr double kFadeShare = 0.4;
/// Strength of the sponge: cubic, with exp(-2 integral(sigma)/c) = 0.2 % for a wave of normal incidence. A stronger
/// sponge returns less of such a wave, but its slope reflects more of an oblique one: 0.01 % gave 6.2 % at 45 degrees
/// (waves of 3 m, sponge of 4 m; `spindrift-study --suite accuracy --case reflection`).
constexpr double kSpongeReturn = 2e-3;
constexpr double kSpongePower = 3.0;

/// Profile of the perfectly matched layer: sigma = sigma_max inside^0.7, with exp(-2 integral(sigma)/c) = 6e-5 for
/// waves of normal incidence that are twice as long as the layer is wide. A matched layer may be much stronger than a
/// sponge, because its slope reflects little; a lower power makes the slope even, which dispersed waves need
/// (docs/absorption.md).
constexpr double kMatchedReturn = 6e-5;
constexpr double kMatchedPower = 0.7;
/// Share of the loss rate that acts along the layer, too. A matched layer amplifies waves that decay along its normal,
/// such as the tails of waves that a bed traps; this share makes up for it. Over an uneven bed it must be larger.
constexpr double kAlongShareFlat = 0.007;
constexpr double kAlongShareUneven = 0.05;

/// Loss rates along x and along z. [1/s]
struct AxisLoss {
  double x_per_s = 0.0;
  double z_per_s = 0.0;
};

/// Depth of the face between two cells: the harmonic mean, as for two half cells in series. 0 when either is dry.
double faceDepth(double a_m, double b_m) {
  return a_m > 0 && b_m > 0 ? 2 * a_m * b_m / (a_m + b_m) : 0.0;
}

/// Loss rates of the layers at a position, from those at the sides and a power. [1/s]
AxisLoss layerLoss(const core::WaveScene& w, const WaveLayout& layout, double most_per_s, double power, double x_m,
                   double z_m) {
  AxisLoss out;
  for (const WaterSide& each : sidesOf(w)) {
    if (each.boundary != WaveBoundary::kAbsorb) continue;
    // 0 at the edge of the layer, 1 at the side.
    const double inside = 1 - distanceTo(each.side, layout.length_m, layout.width_m, x_m, z_m) / w.sponge_width_m;
    if (!(inside > 0)) continue;
    double& loss_per_s = each.bit == MINUS_X_BIT || each.bit == PLUS_X_BIT ? out.x_per_s : out.z_per_s;
    loss_per_s = std::max(loss_per_s, most_per_s * std::pow(inside, power));
  }
  return out;
}

/// Largest loss rate of a matched layer. [1/s]
double matchedLossMax(const core::Scene& scene, const WaveLayout& layout) {
  const double width_m = scene.wave->sponge_width_m;
  double speed_mps = layout.speed_mps;
  if (disperses(scene)) {
    const double k_radpm = std::numbers::pi / width_m;
    speed_mps = std::sqrt(scene.gravity_mps2 / k_radpm * std::tanh(k_radpm * scene.wave->depth_m));
  }
  return (kMatchedPower + 1) * speed_mps * std::log(1 / kMatchedReturn) / (2 * width_m);
}

double heightOf(const core::Obstacle& obstacle) {
  return std::visit([](const auto& o) { return o.height_m; }, obstacle);
}

}  // namespace

std::vector<std::int32_t> restingElevation(const Basin& basin) {
  std::vector<std::int32_t> out(basin.bed.size());
  std::ranges::transform(basin.bed, out.begin(), [](const std::array<float, 4>& cell) {
    return static_cast<std::int32_t>(std::max<std::int64_t>(-bedUnits(cell[2]), 0));
  });
  return out;
}

namespace {

/// Shares of the displacement of effects (Basin::conductance_m), from the number of faces to the next closed one.
void layOutEffectShares(const WaveLayout& layout, Basin& basin) {
  const auto nx = static_cast<int>(layout.count_x);
  const auto nz = static_cast<int>(layout.count_z);
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const int n = axis == 0 ? nx : nz;
    const auto cellOf = [&](int line, int k) {
      const int along = (k + n) % n;
      return static_cast<std::size_t>(axis == 0 ? along + nx * line : line + nx * along);
    };
    for (int line = 0; line < (axis == 0 ? nz : nx); ++line) {
      // Twice around the axis, which may be periodic: the last closed face counts for the first cells.
      for (const int step : {1, -1}) {
        int open_count = EFFECT_TAPER_CELLS;
        for (int k = 0; k < 2 * n; ++k) {
          std::array<float, 4>& face = basin.conductance_m[cellOf(line, (step * k) % n)];
          open_count = face[axis] > 0.0F ? std::min(open_count + 1, EFFECT_TAPER_CELLS) : 0;
          const float share = static_cast<float>(open_count) / static_cast<float>(EFFECT_TAPER_CELLS);
          face[2 + axis] = step == 1 ? share : std::min(face[2 + axis], share);
        }
      }
    }
  }
}

}  // namespace

Basin layOutBasin(const core::Scene& scene, const WaveLayout& layout) {
  const core::WaveScene& w = *scene.wave;
  const auto nx = static_cast<int>(layout.count_x);
  const auto nz = static_cast<int>(layout.count_z);
  const std::size_t cells = layout.counts().total();
  const auto index = [&](int x, int z) {
    if (x < 0 || x >= nx) x = (x + nx) % nx;
    if (z < 0 || z >= nz) z = (z + nz) % nz;
    return static_cast<std::size_t>(x + nx * z);
  };

  Basin out;
  out.is_flat = scene.obstacles.empty() && scene.beaches.empty() && !scene.bed;
  out.depth_m.resize(cells);
  out.conductance_m.resize(cells);
  out.bed.resize(cells);
  const double sigma_max = (kSpongePower + 1) * layout.speed_mps * std::log(1 / kSpongeReturn) / (2 * w.sponge_width_m);
  const bool is_matched = hasMatchedLayer(scene);
  const bool is_nonlinear = isNonlinear(scene);
  const double matched_max = matchedLossMax(scene, layout);
  const double along_share = out.is_flat ? kAlongShareFlat : kAlongShareUneven;
  core::forEachInParallel(layout.count_z, [&](std::size_t row) {
    const int z = static_cast<int>(row);
    for (int x = 0; x < nx; ++x) {
      const std::size_t i = index(x, z);
      const double x_m = (x + 0.5) * layout.cell_m - layout.length_m / 2;
      const double z_m = (z + 0.5) * layout.cell_m - layout.width_m / 2;
      double depth_m = is_nonlinear ? groundDepthWithObstacles(scene, x_m, z_m) : bedDepth(scene, x_m, z_m);
      float ground_m = static_cast<float>(depth_m);
      if (depth_m < kDryShare * w.depth_m || obstacleDistance(scene, x_m, z_m) < 0) depth_m = 0.0;
      out.depth_m[i] = static_cast<float>(depth_m);
      if (!is_nonlinear) ground_m = out.depth_m[i];
      // Beach that runs dry: damp the flow within the time that a long wave needs to cross the shallow part.
      const double shallow = 1 - depth_m / (kFadeShare * w.depth_m);
      double fade = 0.0;
      if (shallow > 0 && !is_nonlinear) {
        for (const core::Beach& beach : scene.beaches) {
          if (beach.shore_depth_m > kDryShare * w.depth_m) continue;
          fade = std::max(fade, 4 * layout.speed_mps / beach.width_m * shallow * shallow);
        }
      }
      if (scene.bed && !is_nonlinear && depth_m < kFadeShare * w.depth_m) {
        // The same where the bed of the scene rises to land, with the width of a beach of its slope.
        if (const auto slope = shoreSlope(scene, x_m, z_m))
          fade = std::max(fade, 4 * layout.speed_mps * *slope / w.depth_m * shallow * shallow);
      }
      if (is_matched) {
        const AxisLoss across = layerLoss(w, layout, matched_max, kMatchedPower, x_m, z_m);
        const double loss_x_per_s = std::max(across.x_per_s, along_share * across.z_per_s);
        const double loss_z_per_s = std::max(across.z_per_s, along_share * across.x_per_s);
        out.bed[i] = {static_cast<float>(fade), static_cast<float>(loss_x_per_s), ground_m,
                      static_cast<float>(loss_z_per_s)};
        continue;
      }
      const AxisLoss loss = layerLoss(w, layout, sigma_max, kSpongePower, x_m, z_m);
      const double sigma = std::max(loss.x_per_s, loss.z_per_s);
      out.bed[i] = {static_cast<float>(sigma + fade), static_cast<float>(sigma), ground_m, 0.0f};
    }
  });

  const bool nine = w.stencil == core::Stencil::kNinePoint;
  const auto depthAt = [&](int x, int z) { return static_cast<double>(out.depth_m[index(x, z)]); };
  const bool is_periodic_x = isPeriodicX(w);
  const bool is_periodic_z = isPeriodicZ(w);
  const auto isInside = [&](int x, int z) {
    return (is_periodic_x || (x >= 0 && x < nx)) && (is_periodic_z || (z >= 0 && z < nz)) && depthAt(x, z) > 0;
  };
  // The square of (x, z) and its neighbours has diagonal faces only if none of its four cells is dry.
  const auto isSquareOpen = [&](int x, int z) {
    return isInside(x, z) && isInside(x + 1, z) && isInside(x, z + 1) && isInside(x + 1, z + 1);
  };
  // Where a square has no diagonal faces, the axis face beside it gets their weight, as if the water were mirrored at
  // the wall.
  const auto axisWeight = [&](int x, int z, int other_x, int other_z) {
    if (!nine) return 1.0;
    return 2.0 / 3.0 + (isSquareOpen(x, z) ? 0.0 : 1.0 / 6.0) + (isSquareOpen(other_x, other_z) ? 0.0 : 1.0 / 6.0);
  };
  for (int z = 0; z < nz; ++z) {
    for (int x = 0; x < nx; ++x) {
      std::array<float, 4>& c = out.conductance_m[index(x, z)];
      c = {0, 0, 0, 0};
      if (!isInside(x, z)) continue;
      const double here = depthAt(x, z);
      if (isInside(x + 1, z)) {
        const double weight = axisWeight(x, z, x, z - 1);
        c[0] = static_cast<float>(weight * faceDepth(here, depthAt(x + 1, z)));
      }
      if (isInside(x, z + 1)) {
        const double weight = axisWeight(x, z, x - 1, z);
        c[1] = static_cast<float>(weight * faceDepth(here, depthAt(x, z + 1)));
      }
    }
  }
  if (disperses(scene)) layOutEffectShares(layout, out);
  if (!nine) return out;
  for (int z = 0; z < nz; ++z) {
    for (int x = 0; x < nx; ++x) {
      if (!isSquareOpen(x, z)) continue;
      std::array<float, 4>& c = out.conductance_m[index(x, z)];
      c[2] = static_cast<float>(faceDepth(depthAt(x, z), depthAt(x + 1, z + 1)) / 6);
      c[3] = static_cast<float>(faceDepth(depthAt(x + 1, z), depthAt(x, z + 1)) / 6);
    }
  }
  return out;
}

Terrain layOutTerrain(const core::Scene& scene, const WaveLayout& layout, const Basin& basin) {
  const auto nx = static_cast<int>(layout.count_x);
  const auto nz = static_cast<int>(layout.count_z);
  const double step_m = 0.25 * layout.cell_m;
  /// Replaces "no obstacle": beyond the range of every lookup, and finite, because infinity would become NaN in
  /// interpolation.
  const double far_m = 4 * layout.longerSide_m();
  const auto distanceAt = [&](double x, double z) { return std::min(obstacleDistance(scene, x, z), far_m); };
  Terrain out;
  out.ground.resize(basin.depth_m.size());
  core::forEachInParallel(layout.count_z, [&](std::size_t row) {
    const int z = static_cast<int>(row);
    for (int x = 0; x < nx; ++x) {
      const double x_m = (x + 0.5) * layout.cell_m - layout.length_m / 2;
      const double z_m = (z + 0.5) * layout.cell_m - layout.width_m / 2;
      const double d = distanceAt(x_m, z_m);
      const double dx = distanceAt(x_m + step_m, z_m) - distanceAt(x_m - step_m, z_m);
      const double dz = distanceAt(x_m, z_m + step_m) - distanceAt(x_m, z_m - step_m);
      const double size = std::max(std::hypot(dx, dz), 1e-12);
      const auto i = static_cast<std::size_t>(x + nx * z);
      // Land is as high as it is; ground that is dry only because it is too shallow is at the rest level.
      const double land_m = std::min(groundDepth(scene, x_m, z_m), 0.0);
      double depth_m = land_m < 0 ? land_m : basin.depth_m[i];
      if (isNonlinear(scene)) {
        depth_m = basin.bed[i][2];
      } else if (d < 0) {
        for (const core::Obstacle& obstacle : scene.obstacles)
          if (obstacleDistance(obstacle, x_m, z_m) < 0) depth_m = std::min(depth_m, -heightOf(obstacle));
      }
      out.ground[i] = {static_cast<float>(d), static_cast<float>(dx / size), static_cast<float>(dz / size),
                       static_cast<float>(depth_m)};
    }
  });

  // Finds the nearest wet cell of each cell: starts from all wet cells and adds one ring of cells at a time.
  out.landing.assign(basin.depth_m.size(), -1);
  std::vector<std::int32_t> front;
  for (std::size_t i = 0; i < basin.depth_m.size(); ++i) {
    if (basin.depth_m[i] <= 0) continue;
    out.landing[i] = static_cast<std::int32_t>(i);
    front.push_back(static_cast<std::int32_t>(i));
  }
  while (!front.empty()) {
    std::vector<std::int32_t> next;
    for (const std::int32_t from : front) {
      const int x = from % nx;
      const int z = from / nx;
      for (const auto& [to_x, to_z] :
           {std::pair{x - 1, z}, std::pair{x + 1, z}, std::pair{x, z - 1}, std::pair{x, z + 1}}) {
        if (to_x < 0 || to_z < 0 || to_x >= nx || to_z >= nz) continue;
        const auto to = static_cast<std::size_t>(to_x + nx * to_z);
        if (out.landing[to] >= 0) continue;
        out.landing[to] = out.landing[static_cast<std::size_t>(from)];
        next.push_back(static_cast<std::int32_t>(to));
      }
    }
    front = std::move(next);
  }
  return out;
}

}  // namespace spindrift::sim
