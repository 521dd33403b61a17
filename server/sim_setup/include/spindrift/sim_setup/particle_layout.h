// Starting positions of the particles, and the grid around them. Part of derive().
#pragma once

#include <spindrift/core/result.h>
#include <spindrift/core/scene.h>
#include <spindrift/sim_setup/derive.h>

namespace spindrift::sim {

/// Largest number of grid cells, 8 bytes each. A pool of a million particles at the default headroom has about 7
/// million.
inline constexpr std::uint32_t kMaxCellCount = 1u << 26;

/// Lays out the particles. `volume_m3`: volume of the water, if given; otherwise it follows from the scene's layers.
/// Errors as derive().
core::Result<ParticleLayout> layOutParticles(const core::Scene& scene, double volume_m3 = 0.0);

/// Returns the standard deviation, in wave cells, of a spread over 4 reach_count + 1 cells
/// (shaders/coupling/splat.glsl).
double splatWidth(std::uint32_t reach_count);

/// Returns k of p = k (rho - rho0): c0^2 over the stress ratio of the lattice.
double stiffnessOf(const core::ParticleScene& particles, const ParticleLayout& layout);

}  // namespace spindrift::sim
