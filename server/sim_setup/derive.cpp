// Everything that follows from a scene, in the order in which it follows; in one file, because each value needs those
// before it.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <shared/fixed_point.h>

#include <spindrift/sim_setup/derive.h>
#include <spindrift/sim_setup/dispersion.h>
#include <spindrift/sim_setup/frame_layout.h>
#include <spindrift/sim_setup/ground.h>
#include <spindrift/sim_setup/incident_waves.h>
#include <spindrift/sim_setup/lattice.h>
#include <spindrift/sim_setup/particle_layout.h>
#include <spindrift/sim_setup/scene_parts.h>
#include <spindrift/sim_setup/sea_state.h>
#include <spindrift/sim_setup/surface_tension.h>

namespace spindrift::sim {
namespace {

using core::Boundary;

/// Share of a support radius that sound plus water may cross in a step. The usual value is 0.4 of half of it (Monaghan
/// 1992), with a large margin: a splashed box stays stable to 1.0 with every kernel set (`spindrift-study --suite
/// stability --case "step,"`).
constexpr double kSoundCourant = 0.7;
/// The same for position-based water, which has no sound. Larger steps compress water by more than a quarter.
constexpr double kParticleCourant = 0.4;
/// Usual values (Monaghan 1992).
constexpr double kForceFactor = 0.25;
constexpr double kViscousFactor = 0.125;
/// Share of its flow that fully breaking water loses in the time sqrt(d/g): a bore ends within a few depths of travel.
constexpr double kBreakingLoss = 0.6;
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
constexpr std::uint32_t kMaxSubstepsCount = 1000;
/// Bound of the neighbour search: this many times the candidates of water at rest, and never less than the minimum
/// below. A lower bound could cut dense spray that leaves the water; a higher one only makes a blow-up slower.
constexpr double kCrowdedRatio = 32.0;
constexpr double kMinCandidates = 1024.0;

using core::invalid;

/// Largest sound speed c = c0 (rho/rho0)^3 of Tait's equation, at the pressure of water with speed U_max that is
/// stopped at the bottom of the band: p = rho0 (U_max^2/2 + g band). With the linear equation c = c0.
double fastestSound(const core::Scene& scene, const ParticleLayout& layout) {
  const core::ParticleScene& p = *scene.particles;
  if (p.equation_of_state == core::EquationOfState::kLinear) return p.sound_speed_mps;
  const double head = 0.5 * p.max_speed_mps * p.max_speed_mps + scene.gravity_mps2 * layout.band_m;
  return p.sound_speed_mps * std::pow(1 + 7 * head / (p.sound_speed_mps * p.sound_speed_mps), 3.0 / 7.0);
}

void addParticleRules(const core::Scene& scene, const ParticleLayout& layout, std::vector<StepRule>& rules) {
  const core::ParticleScene& p = *scene.particles;
  const double H = layout.support_radius_m;
  const double nu = p.viscosity_pas / p.rest_density_kgpm3;
  if (nu > 0)
    rules.push_back({"viscous diffusion, 0.125 H^2 / nu", "particles.viscosity_pas", kViscousFactor * H * H / nu});
  if (hasTension(scene))
    rules.push_back({"surface tension, 0.5 sqrt(rho s^3 / (2 pi sigma))", "particles.surface_tension_npm",
                     capillaryMaxStep(p, layout.spacing_m)});
  if (p.solver == core::PressureSolver::kPositionBased) {
    // There is no sound, and the constraint resists any force: only particles must not jump past each other.
    rules.push_back({"particle CFL, 0.4 H / U_max", "particles.max_speed_mps", kParticleCourant * H / p.max_speed_mps});
    return;
  }
  const bool is_tait = p.equation_of_state == core::EquationOfState::kTait;
  rules.push_back({is_tait ? "particle CFL, 0.7 H / (c + U_max), c = c0 (1 + 7 (U_max^2/2 + g band) / c0^2)^(3/7)"
                           : "particle CFL, 0.7 H / (c0 + U_max)",
                   "particles.sound_speed_mps", kSoundCourant * H / (fastestSound(scene, layout) + p.max_speed_mps)});
  const double downforce = scene.coupling ? scene.coupling->downforce_per_m_s2 * p.headroom_m * p.headroom_m : 0.0;
  const double acceleration = scene.gravity_mps2 + downforce;
  if (acceleration > 0) {
    rules.push_back(
        {"force, 0.25 sqrt(H / a_max)", "coupling.downforce_per_m_s2", kForceFactor * std::sqrt(H / acceleration)});
  }
}

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

/// Lays out cells and speeds; substeps_count, dt_s and courant are left to derive(). Errors (kInvalidInput): cells that
/// do not fit, and choices of the wave that exclude each other. Precondition: the scene has a wave.
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
  if (auto fits = ripplesFit(scene, out.cell_m); !fits) return fits.error();
  out.speed_mps = std::sqrt(scene.gravity_mps2 * w.depth_m);
  if (disperses(scene)) out.dispersing_depth_m = w.depth_m;
  return out;
}

/// Holds in sponges and with any damping, too, because losses are centred in the step (shaders/wave/continuity.comp).
StepRule waveRule(const core::Scene& scene, const WaveLayout& layout) {
  const core::WaveScene& wave = *scene.wave;
  StepRule out{.name = {}, .field = "wave.depth_m"};
  double deepest_m = wave.depth_m;
  for (const core::Beach& beach : scene.beaches) deepest_m = std::max(deepest_m, beach.shore_depth_m);
  const bool steepens = wave.steepening_ratio > 0;
  if (isNonlinear(scene)) {
    out.name = fmt::format("nonlinear wave CFL, {} dx / c", kShallowCourant);
    out.max_dt_s = kShallowCourant * layout.cell_m / std::sqrt(std::max(scene.gravity_mps2 * deepest_m, 1e-18));
  } else if (disperses(scene)) {
    out.name = std::string("wave step with dispersion, 1.8 / (highest frequency of the grid") +
               (steepens ? ", times sqrt(1 + steepening))" : ")");
    // A crest's factor on the slope (see below) may act on all of the waves. Tension multiplies the highest frequency
    // of the grid, that of a chequerboard, which stands 8 times its height above its neighbours.
    out.max_dt_s = dispersedMaxStep(scene.gravity_mps2, deepest_m, layout.cell_m) /
                   std::sqrt((1.0 + wave.steepening_ratio) * (1.0 + 8 * capillaryRatio(scene, layout.cell_m)));
  } else {
    const bool nine = wave.stencil == core::Stencil::kNinePoint;
    const double limit = nine ? kNinePointCourant : kFivePointCourant;
    // Crests of a steepening wave are faster: shaders/wave/momentum.comp bounds d (1 + 3 s eta/d) by d (1 + s).
    const double fastest_mps = layout.speed_mps * std::sqrt(1.0 + wave.steepening_ratio);
    out.name =
        fmt::format("wave CFL, {} dx / {}", nine ? "0.849" : "0.693", steepens ? "(c sqrt(1 + steepening))" : "c");
    out.max_dt_s = fastest_mps > 0 ? kWaveSafety * limit * layout.cell_m / fastest_mps : 1e9;
  }
  return out;
}

std::uint32_t stepsFor(double interval_s, double max_dt_s) {
  return static_cast<std::uint32_t>(std::clamp(std::ceil(interval_s / max_dt_s - 1e-9), 1.0, 1e6));
}

/// Bytes per wave cell: elevation, flow, transfers, tables of a varied basin, buffers read by particles and boats,
/// checkpoints.
std::uint64_t waveCellBytes(const core::Scene& scene) {
  // Elevation; flow and transfer; the share that limits transfers.
  std::uint64_t bytes = 4 + 2 * (scene.wave->stencil == core::Stencil::kNinePoint ? 16 : 8) + 4;
  if (isNonlinear(scene))
    bytes += 2 * 16 - 8 + (disperses(scene) ? 16 : 0);  // FLOW twice; SURFACE_RISE, DISPERSED of the last step
  if (hasRipples(scene)) bytes += 4;
  if (isVaried(scene)) bytes += 16 + 16;
  if (exchangesWater(scene)) bytes += 8;
  if (hasMatchedLayer(scene)) bytes += 4;
  if (isSampled(scene)) bytes += 24 + (isVaried(scene) ? 20 : 0);
  if (hasPressureHead(scene)) bytes += 4;
  if (hasBreakers(scene)) bytes += 32;
  if (hasSurfaceFoam(scene)) bytes += isTwoWay(scene) ? 9 : 8;
  // The state, copied twice by checkpoints.
  std::uint64_t state = 4 + (scene.wave->stencil == core::Stencil::kNinePoint || isNonlinear(scene) ? 16 : 8);
  if (isNonlinear(scene) && disperses(scene)) state += 16;
  if (exchangesWater(scene)) state += 8;
  if (hasMatchedLayer(scene)) state += 4;
  if (hasBreakers(scene)) state += 16;
  if (hasSurfaceFoam(scene)) state += 4;
  return bytes + 2 * state;
}

std::uint64_t deviceBytes(const core::Scene& scene, const Derived& d) {
  std::uint64_t bytes = sizeof(shared::SimUniforms);
  if (d.particles) {
    bytes += std::uint64_t{d.particles->count} * (7 * 16 + 9 * 8 + 8 + 4 + 2 * 2 * 16 +
                                                  (storesFoamSource(scene) ? 4 : 0) + (hasTension(scene) ? 16 : 0)) +
             std::uint64_t{d.particles->cell_count} * 8 + 12;
  }
  if (d.wave) bytes += d.wave->counts().total() * waveCellBytes(scene);
  if (disperses(scene)) bytes += dispersionBytes(*d.wave);
  if (hasWindSea(scene)) bytes += windSeaBytes(d.wave->counts());
  return bytes + (1 + kFrameSlotCount) * frameSlotBytes(scene, d);
}

/// Bound of the neighbour candidates in a column of three cells (all cells of the column in a box that is periodic in
/// height).
std::uint32_t maxCandidates(const core::ParticleScene& particles, const ParticleLayout& layout) {
  const double column_cells = particles.periodic_y ? layout.cells[1] : 3.0;
  const double at_rest = column_cells * std::pow(layout.support_radius_m / layout.spacing_m, 3);
  return static_cast<std::uint32_t>(std::clamp(kCrowdedRatio * at_rest, kMinCandidates, 1e9));
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
    if (!scene.wave) {
      // The lengths by which boats and effects are measured.
      u.wave_length_m = u.wave_width_m = f(std::min(l.max_m[0] - l.min_m[0], l.max_m[2] - l.min_m[2]));
      u.wave_cell_m = f(l.spacing_m);
    }
    const bool follows = scene.coupling && scene.coupling->patch_follow != core::PatchFollow::kNothing;
    const double half_x_m = follows ? d.wave->length_m / 2 : 0.0;
    const double half_z_m = follows ? d.wave->width_m / 2 : 0.0;
    u.frame_min_x_m = f(follows ? -half_x_m : l.min_m[0]);
    u.frame_max_x_m = f(follows ? half_x_m : l.max_m[0]);
    u.frame_min_z_m = f(follows ? -half_z_m : l.min_m[2]);
    u.frame_max_z_m = f(follows ? half_z_m : l.max_m[2]);
    u.density_norm = f(densityNorm(p.kernel_set, H));
    u.slope_norm = f(slopeNorm(p.kernel_set, H));
    u.viscosity_norm = f(viscosityNorm(H));
    u.cubic_norm = f(cubicNorm(H));
    u.floor_drag_pm2 = f(l.floor_drag_pm2);
    u.reentry_m = f(0.01 * l.spacing_m);
    u.band_m = f(l.band_m);
    u.virtual_mass_kg = f(l.virtual_mass_kg);
    u.wall_share = f(l.wall_share);
    u.wall_reach_m = f(l.wall_reach_m);
    u.constraint_softness_pm2 = f(l.constraint_softness_pm2);
    const bool holds_layer = scene.coupling && p.solver == core::PressureSolver::kPositionBased;
    u.floor_gap_m = f((holds_layer ? kPositionBasedFloorGapRatio : kFloorGapRatio) * l.spacing_m);
    const ParticleTension tension = particleTension(p, l);
    u.tension_area_ps2 = f(tension.area_ps2);
    u.tension_pull_ps2 = f(tension.pull_ps2);
    u.tension_wall_m5pkg = f(tension.wall_m5pkg);
    u.candidates_max_count = maxCandidates(p, l);
  }
  if (isTwoWay(scene)) {
    const double s = d.particles->spacing_m;
    u.pool_capacity_count = d.particles->count;
    u.droplet_units =
        static_cast<std::uint32_t>(std::lround(s * s * s / (d.wave->cell_m * d.wave->cell_m) * ELEVATION_UNITS_PER_M));
    u.splat_reach_count = d.particles->splat_reach_count;
    u.splat_width_m = f(splatWidth(d.particles->splat_reach_count) * d.wave->cell_m);
    u.emission_ratio = f(scene.coupling->emission_ratio);
    const double droplet_m = u.droplet_units * double{ELEVATION_UNIT_M};
    const SprayBlocks spray = sprayBlocks(u.splat_reach_count, droplet_m, scene.wave->depth_m);
    u.spray_block_count = spray.block_count;
    u.spray_taken_m = f(spray.taken_ratio * droplet_m);
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
    u.wave_nx = w.count_x;
    u.wave_nz = w.count_z;
    u.wave_length_m = f(w.length_m);
    u.wave_width_m = f(w.width_m);
    u.wave_cell_m = f(w.cell_m);
    u.wave_dt_s = f(w.dt_s);
    u.wave_depth_m = f(scene.wave->depth_m);
    u.wave_damping_per_s = f(scene.wave->damping_per_s);
    u.wave_pull = f(scene.gravity_mps2 * w.dt_s / w.cell_m * ELEVATION_UNIT_M);
    u.wave_transfer = f(w.dt_s / w.cell_m * ELEVATION_UNITS_PER_M);
    u.steepening_ratio = f(scene.wave->steepening_ratio);
    u.capillary_ratio = f(capillaryRatio(scene, w.cell_m));
    u.wave_friction = f(scene.gravity_mps2 * scene.wave->manning_spm13 * scene.wave->manning_spm13);
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
  if (!scene.wave && (scene.storm || !scene.obstacles.empty() || !scene.beaches.empty() || scene.bed ||
                      !scene.gauges.empty() || !scene.wave_makers.empty()))
    return invalid("storm, obstacles, beaches, bed, gauges, wave_makers: need a wave: add one or remove them");
  if (auto checked = checkGround(scene); !checked) return checked.error();

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
    if (auto fits = tensionFits(*scene.particles, layout->spacing_m); !fits) return fits.error();
    addParticleRules(scene, *d.particles, d.rules);
    std::ranges::sort(d.rules, {}, &StepRule::max_dt_s);
  }
  if (scene.wave) {
    auto layout = layOutWave(scene);
    if (!layout) return layout.error();
    d.wave = *layout;
    if (auto fits = makersFit(scene, *d.wave); !fits) return fits.error();
  }

  // Particles decide the number of substeps, 1 without particles. The wave may divide the tick further.
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
    return invalid(fmt::format(
        "{}: needs {} substeps per tick, at most {} are allowed ({}, at most {:.4g} ms): lower it, use fewer "
        "particles or a "
        "higher tick rate",
        rule.field, d.substeps_count, kMaxSubstepsCount, rule.name, rule.max_dt_s * 1e3));
  }
  if (d.wave) {
    const StepRule rule = waveRule(scene, *d.wave);
    d.rules.push_back(rule);
    std::ranges::sort(d.rules, {}, &StepRule::max_dt_s);
    const std::uint32_t needed_count = stepsFor(d.tick_s, rule.max_dt_s);
    const std::uint32_t fixed_count = scene.wave->fixed_substeps_count;
    if (fixed_count != 0 && fixed_count < needed_count && !scene.allow_unstable) {
      return invalid(
          fmt::format("wave.fixed_substeps_count: {} steps of {:.4g} ms are above the bound of {:.4g} ms ({}): use at "
                      "least {}, 0 to "
                      "let the rule choose, or set allow_unstable",
                      fixed_count, d.tick_s / fixed_count * 1e3, rule.max_dt_s * 1e3, rule.name, needed_count));
    }
    d.wave->substeps_count = fixed_count != 0 ? fixed_count : needed_count;
    d.wave->dt_s = d.tick_s / d.wave->substeps_count;
    d.wave->courant = d.wave->speed_mps * d.wave->dt_s / d.wave->cell_m;
    if (d.wave->substeps_count > kMaxSubstepsCount) {
      return invalid(
          fmt::format("wave.depth_m: {:.4g} m needs {} wave steps per tick, at most {} are allowed: use shallower "
                      "water or a coarser wave",
                      scene.wave->depth_m, d.wave->substeps_count, kMaxSubstepsCount));
    }
  }
  d.device_bytes = deviceBytes(scene, d);
  fillUniforms(scene, d);
  return d;
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
  return before.wave && (before.wave->counts() != after.wave->counts() ||
                         before.wave->length_m != after.wave->length_m || before.wave->width_m != after.wave->width_m);
}

}  // namespace spindrift::sim
