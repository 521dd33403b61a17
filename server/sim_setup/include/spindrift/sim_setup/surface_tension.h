// Surface tension: of the wave, whose ripples are faster the shorter they are (docs/dispersion.md), and of particles.
#pragma once

#include <spindrift/core/result.h>
#include <spindrift/core/scene.h>
#include <spindrift/sim_setup/derive.h>

namespace spindrift::sim {

/// Density of the water of a wave.
inline constexpr double kWaveDensity_kgpm3 = 1000.0;

/// Returns the length of the slowest ripples [m], 2 pi sqrt(sigma / (rho g)): 1.7 cm for water.
/// Precondition: hasRipples(scene), gravity.
double slowestRipple_m(const core::Scene& scene);
/// Returns l^2 / dx^2, l^2 = sigma / (rho g), with a correction that makes the curvature of the slowest ripples right
/// on these cells, in the mean of the directions; 0 in scenes without ripples. Precondition: ripplesFit().
double capillaryRatio(const core::Scene& scene, double cell_m);
/// Errors (kInvalidInput): cells that do not resolve ripples, and parts of the scene that do not know them.
core::Result<void> ripplesFit(const core::Scene& scene, double cell_m);

/// Errors (kInvalidInput): water that pulls by itself, or is too compressible for its tension.
core::Result<void> tensionFits(const core::ParticleScene& particles, double spacing_m);

/// Coefficients of shaders/particles/tension.glsl; 0 in scenes without tension.
struct ParticleTension {
  double area_ps2 = 0.0;
  double pull_ps2 = 0.0;
  double wall_m5pkg = 0.0;
};
ParticleTension particleTension(const core::ParticleScene& particles, const ParticleLayout& layout);
/// Returns the largest step with which the shortest ripples of the particles are stable: half of sqrt(rho s^3 / (2 pi
/// sigma)) (Brackbill et al. 1992). Precondition: hasTension().
double capillaryMaxStep(const core::ParticleScene& particles, double spacing_m);

}  // namespace spindrift::sim
