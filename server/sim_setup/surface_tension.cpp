#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <spindrift/sim_setup/scene_parts.h>
#include <spindrift/sim_setup/surface_tension.h>

namespace spindrift::sim {
namespace {

using std::numbers::pi;

/// Least number of cells per wave of the slowest ripples. With 6, their speed differs by 0.6 % from theory along the
/// axes and the diagonals, with 4 by 1.4 %.
constexpr double kLeastCells = 6.0;

/// Shares of the two parts in the tension of particles (shaders/particles/tension.glsl), calibrated by the oscillation
/// of a drop (`spindrift-study --case drop`). With less pull particles leave the surface; with more a drop at rest
/// locks.
constexpr double kAreaShare = 0.77;
constexpr double kPullShare = 0.33;

/// Slowest sound over the speed of ripples as short as a spacing, sqrt(sigma / (rho s)). With half of it a drop of 7
/// spacings oscillates at two thirds of Rayleigh's frequency and loses 3 % of its particles.
constexpr double kSlowestSound = 10.0;

double lengthSquared_m2(const core::Scene& scene) {
  return scene.wave->surface_tension_npm / (kWaveDensity_kgpm3 * scene.gravity_mps2);
}

/// Square of the wave number that a second difference sees, over that of the wave.
double seenShare(double radians_per_cell) {
  const double half = 0.5 * radians_per_cell;
  return std::pow(std::sin(half) / half, 2);
}

}  // namespace

double slowestRipple_m(const core::Scene& scene) {
  return 2 * pi * std::sqrt(lengthSquared_m2(scene));
}

double capillaryRatio(const core::Scene& scene, double cell_m) {
  if (!hasRipples(scene)) return 0.0;
  const double radians = 2 * pi * cell_m / slowestRipple_m(scene);
  const double seen = 0.5 * (seenShare(radians) + seenShare(radians / std::numbers::sqrt2));
  return lengthSquared_m2(scene) / (cell_m * cell_m) / seen;
}

core::Result<void> ripplesFit(const core::Scene& scene, double cell_m) {
  if (!hasRipples(scene)) return {};
  const core::WaveScene& wave = *scene.wave;
  const auto refuse = [&](std::string why) {
    return core::invalid(fmt::format("wave.surface_tension_npm: {} N/m {}, or 0", wave.surface_tension_npm, why));
  };
  if (!disperses(scene)) return refuse("needs short waves at their speed: use dispersion: DISPERSION_AIRY");
  if (isNonlinear(scene)) return refuse("is for BULK_LINEAR: remove wave.bulk");
  if (hasMakers(scene) || hasWindSea(scene))
    return refuse("is not known to wave_makers and to the wind sea of a storm: remove them");
  if (scene.gravity_mps2 <= 0.0 || slowestRipple_m(scene) > wave.side_m) {
    const double least_mps2 = wave.surface_tension_npm / kWaveDensity_kgpm3 * std::pow(2 * pi / wave.side_m, 2);
    return refuse(fmt::format("rules the waves of the whole basin under gravity_mps2: {}: use at least {:.3g}",
                              scene.gravity_mps2, least_mps2));
  }
  const double most_m = slowestRipple_m(scene) / kLeastCells;
  if (cell_m > most_m * (1 + 1e-9))
    return refuse(
        fmt::format("needs cells of at most {:.3g} mm, a sixth of its slowest ripples of {:.3g} mm, and these have "
                    "{:.3g} mm: use a resolution_count of {:.0f} or more, a shorter side_m",
                    1e3 * most_m, 1e3 * slowestRipple_m(scene), 1e3 * cell_m, std::ceil(wave.side_m / most_m)));
  return {};
}

core::Result<void> tensionFits(const core::ParticleScene& p, double spacing_m) {
  if (p.surface_tension_npm <= 0.0) return {};
  if (p.cohesion)
    return core::invalid(
        "particles.surface_tension_npm: needs water whose pressure never pulls: remove cohesion, or use 0");
  const double least_mps = kSlowestSound * std::sqrt(p.surface_tension_npm / (p.rest_density_kgpm3 * spacing_m));
  if (p.solver == core::PressureSolver::kPositionBased || p.sound_speed_mps >= least_mps * (1 - 1e-9)) return {};
  return core::invalid(
      fmt::format("particles.sound_speed_mps: {} m/s is too soft for a surface_tension_npm of {} N/m and particles "
                  "{:.3g} mm apart: use at least {:.3g} m/s, less tension, or PRESSURE_SOLVER_POSITION_BASED",
                  p.sound_speed_mps, p.surface_tension_npm, 1e3 * spacing_m, least_mps));
}

ParticleTension particleTension(const core::ParticleScene& p, const ParticleLayout& layout) {
  if (p.surface_tension_npm <= 0.0) return {};
  const double H = layout.support_radius_m;
  const double rho_0 = p.rest_density_kgpm3;
  const double m = layout.mass_kg;
  // -(dW/dr) / (q (1 - q)^3) of the Wendland kernel.
  const double slope_pm4 = 210 / (pi * std::pow(H, 4));
  // Inside of a flat surface the gradient of c is the kernel's integral over planes, w(z), so that the energy per area
  // is kappa/2 times the integral of w^2 from 0 to H: 0.53705 / H.
  const double kappa_n = 2 * kAreaShare * p.surface_tension_npm * H / 0.53705;
  // Attraction A 4 q (1 - q)^2 between all pairs across a plane in water of even density: sigma = pi/8 n^2 times the
  // integral of r^4 F (Fowler 1937), H^5/42 A.
  const double number_pm3 = rho_0 / m;
  const double attraction_n =
      kPullShare * p.surface_tension_npm * 8 * 42 / (pi * number_pm3 * number_pm3 * std::pow(H, 5));
  return {.area_ps2 = kappa_n * m * m * slope_pm4 * slope_pm4 / (rho_0 * rho_0 * rho_0 * H * H),
          .pull_ps2 = 4 * attraction_n / (m * H),
          // A wall pushes with twice the gradient of the water that it stands for (particles/boundary.glsl).
          .wall_m5pkg = 0.5 * H / (m * slope_pm4)};
}

double capillaryMaxStep(const core::ParticleScene& p, double spacing_m) {
  // With 0.9 half of a position-based drop evaporates; with 0.45 and less nothing does.
  constexpr double kShare = 0.5;
  return kShare * std::sqrt(p.rest_density_kgpm3 * std::pow(spacing_m, 3) / (2 * pi * p.surface_tension_npm));
}

}  // namespace spindrift::sim
