
#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include <spindrift/sim_setup/lattice.h>
#include <spindrift/sim_setup/particle_layout.h>
#include <spindrift/sim_setup/scene_parts.h>

namespace spindrift::sim {
namespace {

using core::Boundary;

/// Softness of the position-based constraint over its squared gradient inside the lattice: with 0 pairs of particles
/// jump, 1 halves every correction.
constexpr double kConstraintSoftness = 0.05;
/// Upper bound of a droplet's height over the depth. A droplet is spread over 25 cells or more, at most 14 % on one; a
/// larger one alone could leave the ground dry.
constexpr double kMaxDropletHeight = 2.0;
/// Standard deviation of a droplet's spread: at least this share of its size s, because otherwise a landing droplet
/// raises cells fast enough to break and emit the next one; and at least the share below of sqrt(s d), for the same
/// effect of many small ones. Found with splashes on 192 to 768 cells: 0.42 s and 0.14 sqrt(s d) ran away; 0.17 emitted
/// a third too much.
constexpr double kSplatWidthRatio = 0.75;
constexpr double kSplatDepthRatio = 0.2;
constexpr std::uint32_t kMaxSplatReach = 8;

using core::invalid;

core::Result<void> countCells(ParticleLayout& out) {
  std::uint64_t cells = 1;
  for (int axis = 0; axis < 3; ++axis) {
    out.cells[axis] = static_cast<std::uint32_t>(
        std::max(1.0, std::ceil((out.max_m[axis] - out.min_m[axis]) / out.support_radius_m - 1e-6)));
    cells *= out.cells[axis];
  }
  if (cells > kMaxCellCount) {
    return invalid(fmt::format(
        "particles.headroom_m: a domain of {} x {} x {} cells has more than {}: use less headroom or fewer particles",
        out.cells[0], out.cells[1], out.cells[2], kMaxCellCount));
  }
  out.cell_count = static_cast<std::uint32_t>(cells);
  return {};
}

/// Support radius for two periodic sides of different length: that of the finest cells that tile both, at most a fifth
/// larger than wanted. None where no such cells exist.
std::optional<double> tilingRadius(double wanted_m, double shorter_m, double longer_m) {
  const double ratio = longer_m / shorter_m;
  for (int k = static_cast<int>(std::floor(shorter_m / wanted_m + 1e-9)); k >= 3 && shorter_m / k <= 1.2 * wanted_m;
       --k) {
    if (std::abs(k * ratio - std::round(k * ratio)) < 1e-6) return shorter_m / k;
  }
  return std::nullopt;
}

/// Layout of a two-way scene: particles of a given volume anywhere over the water, none at the start. It has the wave's
/// sides.
core::Result<ParticleLayout> layOutPool(const core::Scene& scene) {
  const core::ParticleScene& p = *scene.particles;
  ParticleLayout out;
  const core::WaveCells cells = core::waveCellsOf(*scene.wave);
  out.count = p.count;
  out.spacing_m = scene.coupling->droplet_spacing_m;
  out.support_radius_m = p.support_ratio * out.spacing_m;
  // The grid's cells have edge H, and a whole number of them must span a periodic side.
  const bool along_x = isPeriodicX(*scene.wave);
  const bool along_z = isPeriodicZ(*scene.wave);
  if (along_x && along_z && cells.length_m != cells.width_m) {
    const double shorter_m = std::min(cells.length_m, cells.width_m);
    const auto tiled = tilingRadius(out.support_radius_m, shorter_m, std::max(cells.length_m, cells.width_m));
    if (!tiled)
      return invalid(fmt::format(
          "wave.width_m: no support radius near {:.3g} m tiles periodic sides of {:.4g} and {:.4g} m: use a width in a "
          "simple ratio to the length, another droplet_spacing_m, or sides that are not periodic",
          out.support_radius_m, cells.length_m, cells.width_m));
    out.support_radius_m = *tiled;
  } else if (along_x || along_z) {
    const double side_m = along_x ? cells.length_m : cells.width_m;
    out.support_radius_m = side_m / std::max(std::floor(side_m / out.support_radius_m + 1e-9), 3.0);
  }
  out.neighbours_count = latticeNeighbours(out.spacing_m, out.support_radius_m);
  out.mass_kg = calibratedMass(p.kernel_set, out.spacing_m, out.support_radius_m, p.rest_density_kgpm3);
  // Walls do not support spray: share 0, any reach.
  out.wall_reach_m = out.support_radius_m;
  out.constraint_softness_pm2 =
      kConstraintSoftness *
      latticeConstraintSlope2(p.kernel_set, out.spacing_m, out.support_radius_m, p.rest_density_kgpm3, out.mass_kg);
  const double cell_m = cells.cell_m;
  const double droplet_height_m = out.spacing_m * out.spacing_m * out.spacing_m / (cell_m * cell_m);
  if (droplet_height_m > kMaxDropletHeight * scene.wave->depth_m) {
    return invalid(
        fmt::format("coupling.droplet_spacing_m: a droplet of {:.3g} m holds {:.3g} m of one wave cell's water, more "
                    "than {:.3g} of the depth of {:.3g} m: use smaller droplets or a coarser wave",
                    out.spacing_m, droplet_height_m, kMaxDropletHeight, scene.wave->depth_m));
  }
  out.splat_reach_count = 1;
  const double spread_m =
      std::max(kSplatWidthRatio * out.spacing_m, kSplatDepthRatio * std::sqrt(out.spacing_m * scene.wave->depth_m));
  while (splatWidth(out.splat_reach_count) * cell_m < spread_m) ++out.splat_reach_count;
  if (out.splat_reach_count > kMaxSplatReach) {
    return invalid(
        fmt::format("coupling.droplet_spacing_m: a droplet of {:.3g} m has to be spread by {:.3g} m, {:.3g} wave "
                    "cells, of at most {:.3g}: use "
                    "smaller droplets or a coarser wave",
                    out.spacing_m, spread_m, spread_m / cell_m, splatWidth(kMaxSplatReach)));
  }
  out.min_m = {-cells.length_m / 2, -scene.wave->depth_m, -cells.width_m / 2};
  out.max_m = {cells.length_m / 2, p.headroom_m, cells.width_m / 2};
  if (auto counted = countCells(out); !counted) return counted.error();
  return out;
}

/// Support radius H: each periodic side must be a whole number of support radii.
core::Result<double> supportRadius(const core::Scene& scene, double spacing_m, double side_x_m, double side_z_m,
                                   std::uint32_t layers_count) {
  const core::ParticleScene& p = *scene.particles;
  const double wanted_m = p.support_ratio * spacing_m;
  const bool along_x = p.boundary_x == Boundary::kPeriodic;
  const bool along_z = p.boundary_z == Boundary::kPeriodic;
  if (!along_x && !along_z) return wanted_m;
  const double shorter_m = along_x && along_z ? std::min(side_x_m, side_z_m) : along_x ? side_x_m : side_z_m;
  const double cells = std::floor(shorter_m / wanted_m + 1e-9);
  if (cells < 3) {
    return invalid(fmt::format(
        "particles.count: {} particles in {} layers leave {:.0f} cells of the support radius {:.3g} m "
        "across a periodic side of {:.3g} m, at least 3 are needed: use more particles, fewer layers, or walls",
        p.count, layers_count, cells, wanted_m, shorter_m));
  }
  if (!along_x || !along_z || side_x_m == side_z_m) return shorter_m / cells;
  if (const auto tiled = tilingRadius(wanted_m, shorter_m, std::max(side_x_m, side_z_m))) return *tiled;
  return invalid(
      fmt::format("particles.box_width_m: no support radius between {:.3g} and {:.3g} m tiles periodic sides of {:.4g} "
                  "and {:.4g} m: "
                  "use a width in a simple ratio to the length, another count, or walls",
                  wanted_m, 1.2 * wanted_m, side_x_m, side_z_m));
}
/// A box that is periodic in y refuses everything that needs an up and a down.
core::Result<void> checkVerticalPeriod(const core::Scene& scene) {
  const core::ParticleScene& p = *scene.particles;
  if (!p.periodic_y) {
    if (p.fill_density_ratio == 1.0) return {};
    return invalid(
        "particles.fill_density_ratio: water with a surface finds its density by itself: use 1, or a box with "
        "periodic_y and no "
        "surface");
  }
  if (scene.wave || scene.boats || scene.gravity_mps2 != 0.0 || p.fill_x_ratio < 1 || p.fill_z_ratio < 1) {
    return invalid(
        "particles.periodic_y: a box without floor and surface has no wave, no boats, no dam and no gravity: remove "
        "them and set gravity_mps2: 0");
  }
  return {};
}

}  // namespace

double stiffnessOf(const core::ParticleScene& p, const ParticleLayout& layout) {
  const double lattice_ratio =
      latticeStressRatio(p.kernel_set, layout.spacing_m, layout.support_radius_m, p.rest_density_kgpm3, layout.mass_kg);
  return p.sound_speed_mps * p.sound_speed_mps / (lattice_ratio * settledStressRatio(p.kernel_set));
}

core::Result<ParticleLayout> layOutParticles(const core::Scene& scene, double volume_m3) {
  if (auto checked = checkVerticalPeriod(scene); !checked) return checked.error();
  if (isTwoWay(scene)) return layOutPool(scene);
  const core::ParticleScene& p = *scene.particles;
  ParticleLayout out;
  const core::WaveCells water = scene.wave ? core::waveCellsOf(*scene.wave) : core::WaveCells{};
  const double side_x_m = scene.wave ? water.length_m * p.patch_scale : p.box_side_m;
  const double side_z_m = scene.wave            ? water.width_m * p.patch_scale
                          : p.box_width_m > 0.0 ? p.box_width_m
                                                : p.box_side_m;
  const double fill_x_m = p.fill_x_ratio * side_x_m;
  const double fill_z_m = p.fill_z_ratio * side_z_m;
  const double area_m2 = fill_x_m * fill_z_m;
  const auto atLeastOne = [](double v) { return static_cast<std::uint32_t>(std::max(std::lround(v), 1L)); };
  out.layers_count = atLeastOne(volume_m3 > 0 ? volume_m3 / area_m2 / std::cbrt(volume_m3 / p.count) : p.layers_count);
  out.columns_x_count = atLeastOne(fill_x_m / std::sqrt(area_m2 * out.layers_count / p.count));
  // A lattice can have more particles than were wanted, but not more than are allowed.
  for (;; --out.columns_x_count) {
    out.pitch_x_m = fill_x_m / out.columns_x_count;
    out.columns_z_count = atLeastOne(fill_z_m / out.pitch_x_m);
    const std::uint64_t count = std::uint64_t{out.columns_x_count} * out.columns_z_count * out.layers_count;
    out.count = static_cast<std::uint32_t>(count);
    if (count <= kMaxParticleCount || out.columns_x_count == 1) break;
  }
  out.pitch_z_m = fill_z_m / out.columns_z_count;
  out.spacing_m = std::sqrt(out.pitch_x_m * out.pitch_z_m);
  const double s = out.spacing_m;
  out.volume_m3 = volume_m3 > 0 ? volume_m3 : area_m2 * s * out.layers_count;

  const auto support = supportRadius(scene, s, side_x_m, side_z_m, out.layers_count);
  if (!support) return support.error();
  out.support_radius_m = *support;
  const double H = out.support_radius_m;

  const int floor_points = scene.coupling ? static_cast<int>(scene.coupling->lattice_count) : 0;
  out.neighbours_count = latticeNeighbours(s, H);
  out.mass_kg = calibratedMass(p.kernel_set, s, H, p.rest_density_kgpm3);
  if (scene.coupling)
    out.virtual_mass_kg = calibratedVirtualMass(p.kernel_set, s, H, p.rest_density_kgpm3, out.mass_kg, floor_points);
  const WallSupport wall = calibratedWall(p.kernel_set, s, H, p.rest_density_kgpm3, out.mass_kg);
  out.wall_share = wall.share;
  out.wall_reach_m = wall.reach_m;
  out.floor_drag_pm2 = calibratedFloorDrag(s, H, p.rest_density_kgpm3, out.mass_kg, wall);
  out.constraint_softness_pm2 =
      kConstraintSoftness * latticeConstraintSlope2(p.kernel_set, s, H, p.rest_density_kgpm3, out.mass_kg);
  // Position-based water has no stiffness; its layers rest like those of water that is compressed by 1 %.
  const bool is_position_based = p.solver == core::PressureSolver::kPositionBased;
  const double stiffness = is_position_based ? 100 * scene.gravity_mps2 * s * out.layers_count : stiffnessOf(p, out);
  core::ParticleScene resting = p;
  if (is_position_based) {
    resting.equation_of_state = core::EquationOfState::kLinear;
    resting.pressure_force = core::PressureForce::kConserving;
    resting.cohesion = false;
  }
  out.layer_heights_m = restingLayers(resting, out, stiffness, scene.gravity_mps2, floor_points);
  if (p.periodic_y && out.layers_count * s < 2 * H) {
    return invalid(fmt::format(
        "particles.layers_count: {} layers of {:.3g} m are less than two support radii of {:.3g} m, and a particle "
        "would meet its own images across the periodic height: use at least {:.0f}",
        out.layers_count, s, H, std::ceil(2 * H / s - 1e-9)));
  }
  // A dam's column is free on one side: it starts at rest density, because with the pressure of water between walls its
  // free side would burst. The layers of a box without a surface carry no weight.
  if (p.periodic_y || p.fill_x_ratio < 1 || p.fill_z_ratio < 1) {
    for (std::size_t k = 0; k < out.layer_heights_m.size(); ++k)
      out.layer_heights_m[k] = (static_cast<double>(k) + 0.5) * s;
  }
  out.band_m = out.layer_heights_m.back() + s / 2;
  const double centre_x = scene.wave ? p.patch_shift_x_m : 0.0;
  const double centre_z = scene.wave ? p.patch_shift_z_m : 0.0;
  // Below the band the floor can be as low as the water is deep.
  const double lowest_m = -out.band_m - (scene.coupling ? scene.wave->depth_m : 0.0);
  out.min_m = {centre_x - side_x_m / 2, lowest_m, centre_z - side_z_m / 2};
  out.max_m = {centre_x + side_x_m / 2, p.periodic_y ? 0.0 : p.headroom_m, centre_z + side_z_m / 2};
  out.mass_kg *= p.fill_density_ratio;
  if (scene.wave) {
    const double half_x_m = water.length_m / 2 * (1 + 1e-9);
    const double half_z_m = water.width_m / 2 * (1 + 1e-9);
    if (out.min_m[0] < -half_x_m || out.max_m[0] > half_x_m || out.min_m[2] < -half_z_m || out.max_m[2] > half_z_m) {
      return invalid(fmt::format(
          "particles.patch_shift_x_m, patch_shift_z_m: a patch of {:.3g} x {:.3g} m centred at ({:.3g}, {:.3g}) m "
          "leaves the water of {:.3g} x {:.3g} m: move it inside or make patch_scale smaller",
          side_x_m, side_z_m, centre_x, centre_z, water.length_m, water.width_m));
    }
  }
  if (auto counted = countCells(out); !counted) return counted.error();
  return out;
}

core::Result<ParticleLayout> layOutAgain(const core::Scene& scene, const ParticleLayout& before) {
  return layOutParticles(scene, before.volume_m3);
}

double splatWidth(std::uint32_t reach_count) {
  const double boxes = reach_count + 1.0;
  return std::sqrt((boxes * boxes - 1) / 3);
}

namespace {

constexpr double kLargestTaken = 0.5;  ///< of the depth
constexpr std::uint32_t kLargestBlock = 16;

double chooseThree(int x) {
  return x < 3 ? 0.0 : x * (x - 1.0) * (x - 2.0) / 6.0;
}

/// The same as splatWeight() of shaders/coupling/splat.glsl.
double splatWeight(int offset, int reach) {
  const int k = 2 * reach - std::abs(offset);
  if (k < 0) return 0.0;
  return (chooseThree(k + 3) - 4 * chooseThree(k + 2 - reach)) / std::pow(reach + 1.0, 4);
}

/// Largest sum of weights on one axis if each block of `block` cells holds one particle, at any position in it.
double largestSum(int reach, int block) {
  double largest = 0.0;
  for (int shift = 0; shift < block; ++shift) {
    double sum = 0.0;
    for (int first = -2 * reach - shift; first <= 2 * reach; first += block) {
      double most = 0.0;
      for (int offset = first; offset < first + block; ++offset) most = std::max(most, splatWeight(offset, reach));
      sum += most;
    }
    largest = std::max(largest, sum);
  }
  return largest;
}

}  // namespace

SprayBlocks sprayBlocks(std::uint32_t reach_count, double droplet_m, double depth_m) {
  SprayBlocks out;
  for (std::uint32_t block = 1;; block *= 2) {
    const double sum = largestSum(static_cast<int>(reach_count), static_cast<int>(block));
    out = {block, sum * sum};
    if (out.taken_ratio * droplet_m <= kLargestTaken * depth_m || block == kLargestBlock) return out;
  }
}

}  // namespace spindrift::sim
