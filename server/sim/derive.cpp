#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <shared/fixed_point.h>

#include <spindrift/sim/derive.h>

#include "basin.h"
#include "lattice.h"

namespace spindrift::sim {
namespace {

using core::Boundary;
using core::Error;
using core::ErrorCode;
using std::numbers::pi;

/// Usual values of weakly compressible SPH (Monaghan 1992; PHYSICS section 3); larger than these and runs blow up.
constexpr double kParticleCourant = 0.4;
constexpr double kForceFactor = 0.25;
constexpr double kViscousFactor = 0.125;
/// Stability limits of the leapfrog on a square grid: 1/sqrt(2), and sqrt(3)/2 for the isotropic 9-point stencil.
constexpr double kFivePointCourant = 0.70710678;
constexpr double kNinePointCourant = 0.8660254;
/// Share of the wave's limit that is used: room for rounding, not for physics.
constexpr double kWaveSafety = 0.98;
/// Share of its flow that fully breaking water loses in the time sqrt(d/g): a bore is gone within a few depths' travel.
constexpr double kBreakingLoss = 0.6;
/// Softness of the position-based constraint over its squared gradient inside the lattice: 0 makes lone pairs jump, 1
/// halves every correction.
constexpr double kConstraintSoftness = 0.05;
constexpr std::uint32_t kMaxSubstepsCount = 1000;
constexpr std::uint32_t kMaxCellCount = 1u << 22;
/// A droplet is spread over 25 cells, at most 14 % on one; more than this and a single one would bare the ground.
constexpr double kMaxDropletHeight = 2.0;

Error invalid(std::string message) {
  return {ErrorCode::kInvalidInput, std::move(message)};
}

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

/// Two-way: particles of a given volume anywhere over the water, none at the start. Sides are the wave's.
core::Result<ParticleLayout> layOutPool(const core::Scene& scene) {
  const core::ParticleScene& p = *scene.particles;
  ParticleLayout out;
  const double side_m = scene.wave->side_m;
  out.count = p.count;
  out.spacing_m = scene.coupling->droplet_spacing_m;
  out.support_radius_m = p.support_ratio * out.spacing_m;
  if (isPeriodicX(*scene.wave) || isPeriodicZ(*scene.wave)) {
    // The grid's cells have edge H and must tile a periodic side exactly.
    out.support_radius_m = side_m / std::max(std::floor(side_m / out.support_radius_m + 1e-9), 3.0);
  }
  out.neighbours_count = latticeNeighbours(out.spacing_m, out.support_radius_m);
  out.mass_kg = calibratedMass(p.kernel_set, out.spacing_m, out.support_radius_m, p.rest_density_kgpm3);
  // Walls do not support spray: a share of 0 over any reach.
  out.wall_reach_m = out.support_radius_m;
  out.constraint_softness_pm2 =
      kConstraintSoftness *
      latticeConstraintSlope2(p.kernel_set, out.spacing_m, out.support_radius_m, p.rest_density_kgpm3, out.mass_kg);
  const double cell_m = side_m / scene.wave->resolution_count;
  const double droplet_height_m = out.spacing_m * out.spacing_m * out.spacing_m / (cell_m * cell_m);
  if (droplet_height_m > kMaxDropletHeight * scene.wave->depth_m) {
    return invalid(
        fmt::format("coupling.droplet_spacing_m: a droplet of {:.3g} m holds {:.3g} m of one wave cell's water, more "
                    "than {:.3g} of the depth of {:.3g} m: use smaller droplets or a coarser wave",
                    out.spacing_m, droplet_height_m, kMaxDropletHeight, scene.wave->depth_m));
  }
  out.min_m = {-side_m / 2, -scene.wave->depth_m, -side_m / 2};
  out.max_m = {side_m / 2, p.headroom_m, side_m / 2};
  if (auto counted = countCells(out); !counted) return counted.error();
  return out;
}

/// Largest c of Tait's equation: c = c0 (rho/rho0)^3 at the pressure with which water of U_max comes to rest at the
/// bottom of the band, p = rho0 (U_max^2/2 + g band). Linear water has c0 everywhere.
double fastestSound(const core::Scene& scene, const ParticleLayout& layout) {
  const core::ParticleScene& p = *scene.particles;
  if (p.equation_of_state == core::EquationOfState::kLinear) return p.sound_speed_mps;
  const double head = 0.5 * p.max_speed_mps * p.max_speed_mps + scene.gravity_mps2 * layout.band_m;
  return p.sound_speed_mps * std::pow(1 + 7 * head / (p.sound_speed_mps * p.sound_speed_mps), 3.0 / 7.0);
}

/// The support radius: whole cells of it must tile every periodic side.
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
  // Two periodic sides of different length: the coarsest tiling of both that widens the support by at most a fifth.
  const double ratio = std::max(side_x_m, side_z_m) / shorter_m;
  for (double k = cells; k >= 3 && shorter_m / k <= 1.2 * wanted_m; --k) {
    if (std::abs(k * ratio - std::round(k * ratio)) < 1e-6) return shorter_m / k;
  }
  return invalid(
      fmt::format("particles.box_width_m: no support radius between {:.3g} and {:.3g} m tiles periodic sides of {:.4g} "
                  "and {:.4g} m: "
                  "use a width in a simple ratio to the length, another count, or walls",
                  wanted_m, 1.2 * wanted_m, side_x_m, side_z_m));
}

/// k of the equation of state, such that the lattice's stress is c0^2 (rho - rho0).
double stiffnessOf(const core::ParticleScene& p, const ParticleLayout& layout) {
  return p.sound_speed_mps * p.sound_speed_mps /
         latticeStressRatio(p.kernel_set, layout.spacing_m, layout.support_radius_m, p.rest_density_kgpm3,
                            layout.mass_kg);
}

/// `volume_m3`: of the water, when it is given; else the scene's layers decide.
core::Result<ParticleLayout> layOutParticles(const core::Scene& scene, double volume_m3 = 0.0) {
  if (isTwoWay(scene)) return layOutPool(scene);
  const core::ParticleScene& p = *scene.particles;
  ParticleLayout out;
  const double side_x_m = (scene.wave ? scene.wave->side_m : p.box_side_m) * (scene.wave ? p.patch_scale : 1.0);
  const double side_z_m = !scene.wave && p.box_width_m > 0 ? p.box_width_m : side_x_m;
  const double fill_x_m = p.fill_x_ratio * side_x_m;
  const double fill_z_m = p.fill_z_ratio * side_z_m;
  const double area_m2 = fill_x_m * fill_z_m;
  const auto atLeastOne = [](double v) { return static_cast<std::uint32_t>(std::max(std::lround(v), 1L)); };
  out.layers_count = atLeastOne(volume_m3 > 0 ? volume_m3 / area_m2 / std::cbrt(volume_m3 / p.count) : p.layers_count);
  out.columns_x_count = atLeastOne(fill_x_m / std::sqrt(area_m2 * out.layers_count / p.count));
  out.pitch_x_m = fill_x_m / out.columns_x_count;
  out.columns_z_count = atLeastOne(fill_z_m / out.pitch_x_m);
  out.pitch_z_m = fill_z_m / out.columns_z_count;
  out.count = out.columns_x_count * out.columns_z_count * out.layers_count;
  out.spacing_m = std::sqrt(out.pitch_x_m * out.pitch_z_m);
  const double s = out.spacing_m;
  out.volume_m3 = volume_m3 > 0 ? volume_m3 : area_m2 * s * out.layers_count;

  const auto support = supportRadius(scene, s, side_x_m, side_z_m, out.layers_count);
  if (!support) return support.error();
  out.support_radius_m = *support;
  const double H = out.support_radius_m;

  const int floor_points = scene.coupling ? static_cast<int>(scene.coupling->lattice_count) : kFlatFloorLattice;
  out.neighbours_count = latticeNeighbours(s, H);
  out.mass_kg = calibratedMass(p.kernel_set, s, H, p.rest_density_kgpm3);
  out.virtual_mass_kg = calibratedVirtualMass(p.kernel_set, s, H, p.rest_density_kgpm3, out.mass_kg, floor_points);
  const WallSupport wall = calibratedWall(p.kernel_set, s, H, p.rest_density_kgpm3, out.mass_kg);
  out.wall_share = wall.share;
  out.wall_reach_m = wall.reach_m;
  out.constraint_softness_pm2 =
      kConstraintSoftness * latticeConstraintSlope2(p.kernel_set, s, H, p.rest_density_kgpm3, out.mass_kg);
  // Position-based water has no stiffness; its layers rest as those of a water that gives way by a hundredth.
  const bool is_position_based = p.solver == core::PressureSolver::kPositionBased;
  const double stiffness = is_position_based ? 100 * scene.gravity_mps2 * s * out.layers_count : stiffnessOf(p, out);
  out.layer_heights_m =
      restingLayers({.kernel_set = p.kernel_set,
                     .spacing_m = s,
                     .support_radius_m = H,
                     .rest_density_kgpm3 = p.rest_density_kgpm3,
                     .stiffness_m2ps2 = stiffness,
                     .gravity_mps2 = scene.gravity_mps2,
                     .mass_kg = out.mass_kg,
                     .virtual_mass_kg = out.virtual_mass_kg,
                     .floor_points = floor_points,
                     .equation_of_state = is_position_based ? core::EquationOfState::kLinear : p.equation_of_state,
                     .pressure_force = is_position_based ? core::PressureForce::kConserving : p.pressure_force,
                     .cohesion = p.cohesion && !is_position_based},
                    static_cast<int>(out.layers_count));
  out.band_m = out.layer_heights_m.back() + s / 2;
  const double centre_x = scene.wave ? p.patch_shift_x_m : 0.0;
  const double centre_z = scene.wave ? p.patch_shift_z_m : 0.0;
  // Below the band the floor can sink as far as the water is deep.
  const double lowest_m = -out.band_m - (scene.coupling ? scene.wave->depth_m : 0.0);
  out.min_m = {centre_x - side_x_m / 2, lowest_m, centre_z - side_z_m / 2};
  out.max_m = {centre_x + side_x_m / 2, p.headroom_m, centre_z + side_z_m / 2};
  if (scene.wave) {
    const double half_m = scene.wave->side_m / 2 * (1 + 1e-9);
    if (out.min_m[0] < -half_m || out.max_m[0] > half_m || out.min_m[2] < -half_m || out.max_m[2] > half_m) {
      return invalid(fmt::format(
          "particles.patch_shift_x_m, patch_shift_z_m: a patch of {:.3g} m centred at ({:.3g}, {:.3g}) m leaves the "
          "water of {:.3g} m: move it inside or make patch_scale smaller",
          side_x_m, centre_x, centre_z, scene.wave->side_m));
    }
  }
  if (auto counted = countCells(out); !counted) return counted.error();
  return out;
}

void addParticleRules(const core::Scene& scene, const ParticleLayout& layout, std::vector<StepRule>& rules) {
  const core::ParticleScene& p = *scene.particles;
  const double H = layout.support_radius_m;
  const double nu = p.viscosity_pas / p.rest_density_kgpm3;
  if (nu > 0)
    rules.push_back({"viscous diffusion, 0.125 H^2 / nu", "particles.viscosity_pas", kViscousFactor * H * H / nu});
  if (p.solver == core::PressureSolver::kPositionBased) {
    // No sound, and a constraint answers to any force: only particles must not jump past each other.
    rules.push_back({"particle CFL, 0.4 H / U_max", "particles.max_speed_mps", kParticleCourant * H / p.max_speed_mps});
    return;
  }
  const bool is_tait = p.equation_of_state == core::EquationOfState::kTait;
  rules.push_back({is_tait ? "particle CFL, 0.4 H / (c + U_max), c = c0 (1 + 7 (U_max^2/2 + g band) / c0^2)^(3/7)"
                           : "particle CFL, 0.4 H / (c0 + U_max)",
                   "particles.sound_speed_mps",
                   kParticleCourant * H / (fastestSound(scene, layout) + p.max_speed_mps)});
  const double downforce = scene.coupling ? scene.coupling->downforce_per_m_s2 * p.headroom_m * p.headroom_m : 0.0;
  const double acceleration = scene.gravity_mps2 + downforce;
  if (acceleration > 0) {
    rules.push_back(
        {"force, 0.25 sqrt(H / a_max)", "coupling.downforce_per_m_s2", kForceFactor * std::sqrt(H / acceleration)});
  }
}

core::Result<WaveLayout> layOutWave(const core::Scene& scene) {
  const core::WaveScene& w = *scene.wave;
  WaveLayout out;
  out.resolution_count = w.resolution_count;
  out.side_m = w.side_m;
  out.cell_m = w.side_m / w.resolution_count;
  out.speed_mps = std::sqrt(scene.gravity_mps2 * w.depth_m);
  return out;
}

double waveMaxStep(const core::WaveScene& wave, const WaveLayout& layout) {
  const double limit = wave.stencil == core::Stencil::kNinePoint ? kNinePointCourant : kFivePointCourant;
  // Crests of a steepening wave are faster: shaders/wave/momentum.comp bounds d (1 + 3 s eta/d) by d (1 + s).
  const double fastest_mps = layout.speed_mps * std::sqrt(1.0 + wave.steepening_ratio);
  return fastest_mps > 0 ? kWaveSafety * limit * layout.cell_m / fastest_mps : 1e9;
}

std::uint32_t stepsFor(double interval_s, double max_dt_s) {
  return static_cast<std::uint32_t>(std::clamp(std::ceil(interval_s / max_dt_s - 1e-9), 1.0, 1e6));
}

/// Bytes a wave cell: elevation, flow, tables of a varied basin, what particles and boats read.
std::uint64_t waveCellBytes(const core::Scene& scene) {
  std::uint64_t bytes = 4 + (scene.wave->stencil == core::Stencil::kNinePoint ? 16 : 8);
  if (isVaried(scene)) bytes += 16 + 8;
  if (isOpen(scene)) bytes += 4;
  if (isSampled(scene)) bytes += 24 + (isVaried(scene) ? 20 : 0);
  if (hasPressureHead(scene)) bytes += 4;
  if (hasBreakers(scene)) bytes += 32;
  if (hasSurfaceFoam(scene)) bytes += isTwoWay(scene) ? 9 : 8;
  return bytes;
}

std::uint64_t deviceBytes(const core::Scene& scene, const Derived& d) {
  std::uint64_t bytes = sizeof(shared::SimUniforms);
  if (d.particles) {
    bytes += std::uint64_t{d.particles->count} * (7 * 16 + 8 + 4 + (storesFoamSource(scene) ? 4 : 0)) +
             std::uint64_t{d.particles->cell_count} * 8 + 4;
  }
  if (d.wave) bytes += std::uint64_t{d.wave->resolution_count} * d.wave->resolution_count * waveCellBytes(scene);
  return bytes;
}

void fillUniforms(const core::Scene& scene, Derived& d) {
  shared::SimUniforms& u = d.uniforms;
  const auto f = [](double v) { return static_cast<float>(v); };
  u.dt_s = f(d.dt_s);
  u.tick_s = f(d.tick_s);
  u.gravity_mps2 = f(scene.gravity_mps2);
  if (d.particles) {
    const ParticleLayout& l = *d.particles;
    const core::ParticleScene& p = *scene.particles;
    const double H = l.support_radius_m;
    u.min_x_m = f(l.min_m[0]);
    u.min_y_m = f(l.min_m[1]);
    u.min_z_m = f(l.min_m[2]);
    u.max_x_m = f(l.max_m[0]);
    u.max_y_m = f(l.max_m[1]);
    u.max_z_m = f(l.max_m[2]);
    u.support_radius_m = f(H);
    u.spacing_m = f(l.spacing_m);
    u.particle_count = l.count;
    u.cells_x = l.cells[0];
    u.cells_y = l.cells[1];
    u.cells_z = l.cells[2];
    u.cell_count = l.cell_count;
    u.mass_kg = f(l.mass_kg);
    u.rest_density_kgpm3 = f(p.rest_density_kgpm3);
    u.stiffness_m2ps2 = f(stiffnessOf(p, l));
    u.viscosity_pas = f(p.viscosity_pas);
    u.max_speed_mps = f(p.max_speed_mps);
    const bool follows = scene.coupling && scene.coupling->patch_follow != core::PatchFollow::kNothing;
    const double half_m = follows ? scene.wave->side_m / 2 : 0.0;
    u.frame_min_x_m = f(follows ? -half_m : l.min_m[0]);
    u.frame_max_x_m = f(follows ? half_m : l.max_m[0]);
    u.frame_min_z_m = f(follows ? -half_m : l.min_m[2]);
    u.frame_max_z_m = f(follows ? half_m : l.max_m[2]);
    u.density_norm = f(densityNorm(p.kernel_set, H));
    u.slope_norm = f(slopeNorm(p.kernel_set, H));
    u.viscosity_norm = f(viscosityNorm(H));
    u.cubic_norm = f(cubicNorm(H));
    u.wall_restitution = 0.0f;
    u.reentry_m = f(0.01 * l.spacing_m);
    u.band_m = f(l.band_m);
    u.virtual_mass_kg = f(l.virtual_mass_kg);
    u.wall_share = f(l.wall_share);
    u.wall_reach_m = f(l.wall_reach_m);
    u.constraint_softness_pm2 = f(l.constraint_softness_pm2);
    u.floor_gap_m = f(kFloorGapRatio * l.spacing_m);
  }
  if (isTwoWay(scene)) {
    const double s = d.particles->spacing_m;
    u.pool_capacity_count = d.particles->count;
    u.droplet_units =
        static_cast<std::uint32_t>(std::lround(s * s * s / (d.wave->cell_m * d.wave->cell_m) * ELEVATION_UNITS_PER_M));
    u.emission_ratio = f(scene.coupling->emission_ratio);
    u.seed = static_cast<std::uint32_t>(scene.seed);
  }
  if (scene.coupling) u.downforce_per_m_s2 = f(scene.coupling->downforce_per_m_s2);
  if (scene.foam) {
    u.foam_deficit_ratio = f(scene.foam->density_deficit_ratio);
    u.foam_neighbours = f(scene.foam->neighbours_count);
    u.foam_keep_ratio = f(std::exp(-d.dt_s / scene.foam->lifetime_s));
    u.breaking_foam_keep_ratio = f(std::exp(-d.tick_s / scene.foam->breaking_lifetime_s));
    u.wake_foam_keep_ratio = f(std::exp(-d.tick_s / scene.foam->wake_lifetime_s));
    u.landing_foam_keep_ratio = f(std::exp(-d.tick_s / scene.foam->landing_lifetime_s));
  }
  if (d.wave) {
    const WaveLayout& w = *d.wave;
    u.wave_n = w.resolution_count;
    u.wave_side_m = f(w.side_m);
    u.wave_cell_m = f(w.cell_m);
    u.wave_dt_s = f(w.dt_s);
    u.wave_depth_m = f(scene.wave->depth_m);
    u.wave_damping_per_s = f(scene.wave->damping_per_s);
    u.wave_pull = f(scene.gravity_mps2 * w.dt_s / w.cell_m * ELEVATION_UNIT_M);
    u.wave_transfer = f(w.dt_s / w.cell_m * ELEVATION_UNITS_PER_M);
    u.steepening_ratio = f(scene.wave->steepening_ratio);
    u.breaking_loss_per_s = f(kBreakingLoss * std::sqrt(scene.gravity_mps2 / scene.wave->depth_m));
  }
  u.surface_quantum_m = f(scene.stream.surface_quantum_m);
}

}  // namespace

core::Result<Derived> derive(const core::Scene& scene, const ParticleLayout* kept) {
  if (!scene.wave && !scene.particles) return invalid("wave, particles: a scene needs at least one of them");
  if (scene.coupling && !(scene.wave && scene.particles))
    return invalid("coupling: needs both wave and particles: add the missing part or remove coupling");
  if (scene.foam && !scene.particles && !hasSurfaceFoam(scene))
    return invalid("foam: needs particles, or a wave and surface: true: add what is missing or remove foam");
  if (!scene.wave && (scene.boats || scene.storm || !scene.obstacles.empty() || !scene.beaches.empty()))
    return invalid("boats, storm, obstacles, beaches: need a wave: add one or remove them");

  if (scene.coupling && scene.coupling->patch_follow != core::PatchFollow::kNothing) {
    if (isTwoWay(scene))
      return invalid("coupling.patch_follow: the particles of a two-way scene are all over the water: leave it out");
    if (scene.particles->boundary_x != Boundary::kPeriodic || scene.particles->boundary_z != Boundary::kPeriodic)
      return invalid(
          "coupling.patch_follow: a patch that moves needs periodic sides: make particles.boundary_x and "
          "boundary_z periodic");
    if (scene.coupling->patch_follow == core::PatchFollow::kBoat && !scene.boats)
      return invalid("coupling.patch_follow: BOAT needs boats: add \"boats {}\"");
  }

  Derived d;
  d.tick_s = 1.0 / scene.tick_rate_hz;
  if (scene.particles) {
    auto layout = kept ? core::Result<ParticleLayout>(*kept) : layOutParticles(scene);
    if (!layout) return layout.error();
    d.particles = *layout;
    addParticleRules(scene, *d.particles, d.rules);
    std::ranges::sort(d.rules, {}, &StepRule::max_dt_s);
  }
  if (scene.wave) {
    auto layout = layOutWave(scene);
    if (!layout) return layout.error();
    d.wave = *layout;
  }

  // Particles set the substep; without them one substep a tick, and the wave divides it further.
  const std::uint32_t needed = d.rules.empty() ? 1 : stepsFor(d.tick_s, d.rules.front().max_dt_s);
  d.substeps_count = scene.fixed_substeps_count ? scene.fixed_substeps_count : needed;
  d.dt_s = d.tick_s / d.substeps_count;
  if (!scene.allow_unstable && !d.rules.empty() && d.substeps_count < needed) {
    const StepRule& rule = d.rules.front();
    return invalid(
        fmt::format("fixed_substeps_count: {} substeps give a step of {:.4g} ms, above the bound of {:.4g} ms ({}): "
                    "use at least {}, "
                    "lower {}, or set allow_unstable",
                    d.substeps_count, d.dt_s * 1e3, rule.max_dt_s * 1e3, rule.name, needed, rule.field));
  }
  if (d.substeps_count > kMaxSubstepsCount) {
    const StepRule& rule = d.rules.front();
    return invalid(
        fmt::format("{}: needs {} substeps a tick, at most {} are allowed ({}, at most {:.4g} ms): lower it, use fewer "
                    "particles or a "
                    "higher tick rate",
                    rule.field, d.substeps_count, kMaxSubstepsCount, rule.name, rule.max_dt_s * 1e3));
  }
  if (d.wave) {
    const double max_dt_s = waveMaxStep(*scene.wave, *d.wave);
    d.rules.push_back(
        {scene.wave->stencil == core::Stencil::kNinePoint ? "wave CFL, 0.849 dx / c" : "wave CFL, 0.693 dx / c",
         "wave.depth_m", max_dt_s});
    std::ranges::sort(d.rules, {}, &StepRule::max_dt_s);
    d.wave->substeps_count = stepsFor(d.tick_s, max_dt_s);
    d.wave->dt_s = d.tick_s / d.wave->substeps_count;
    d.wave->courant = d.wave->speed_mps * d.wave->dt_s / d.wave->cell_m;
    if (d.wave->substeps_count > kMaxSubstepsCount) {
      return invalid(
          fmt::format("wave.depth_m: {:.4g} m needs {} wave steps a tick, at most {} are allowed: use shallower "
                      "water or a coarser wave",
                      scene.wave->depth_m, d.wave->substeps_count, kMaxSubstepsCount));
    }
  }
  d.device_bytes = deviceBytes(scene, d);
  fillUniforms(scene, d);
  return d;
}

core::Result<ParticleLayout> layOutAgain(const core::Scene& scene, const ParticleLayout& before) {
  return layOutParticles(scene, before.volume_m3);
}

bool countsNeighbours(const core::Scene& scene) {
  return scene.particles && scene.foam && scene.foam->neighbours_count > 0;
}

bool storesFoamSource(const core::Scene& scene) {
  return countsNeighbours(scene) && scene.particles->solver == core::PressureSolver::kWeaklyCompressible;
}

bool needsRestart(const Derived& before, const Derived& after) {
  if (before.particles.has_value() != after.particles.has_value() || before.wave.has_value() != after.wave.has_value())
    return true;
  if (before.particles) {
    const ParticleLayout& a = *before.particles;
    const ParticleLayout& b = *after.particles;
    if (a.columns_x_count != b.columns_x_count || a.columns_z_count != b.columns_z_count ||
        a.layers_count != b.layers_count || a.support_radius_m != b.support_radius_m || a.volume_m3 != b.volume_m3)
      return true;
  }
  return before.wave &&
         (before.wave->resolution_count != after.wave->resolution_count || before.wave->side_m != after.wave->side_m);
}

}  // namespace spindrift::sim
