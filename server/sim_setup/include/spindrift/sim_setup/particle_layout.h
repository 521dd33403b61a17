// Starting positions of the particles, and the grid around them. Part of derive().
#pragma once

#include <shared/groups.h>

#include <spindrift/core/result.h>
#include <spindrift/core/scene.h>
#include <spindrift/sim_setup/derive.h>

namespace spindrift::sim {

/// Largest number of grid cells, 8 bytes each. A pool of a million particles at the default headroom has about 7
/// million.
inline constexpr std::uint32_t kMaxCellCount = 1u << 26;
/// Largest number of particles, 4,194,240: those of one dispatch of the smallest groups that a tuning profile may have.
inline constexpr std::uint32_t kMaxParticleCount = MAX_GROUPS * POOL_GROUP;

/// Lays out the particles. `volume_m3`: volume of the water, if given; otherwise it follows from the scene's layers.
/// Errors as derive().
core::Result<ParticleLayout> layOutParticles(const core::Scene& scene, double volume_m3 = 0.0);

/// Returns the standard deviation, in wave cells, of a spread over 4 reach_count + 1 cells
/// (shaders/coupling/splat.glsl).
double splatWidth(std::uint32_t reach_count);

/// At most one cell in each block of block_count x block_count cells emits per tick; then all particles of a tick
/// together take at most `taken_ratio` of a particle's volume from any cell.
struct SprayBlocks {
  std::uint32_t block_count = 1;  ///< a power of two: it divides every resolution
  double taken_ratio = 1.0;
};

/// Returns the smallest blocks for which a tick takes at most half of the depth from a cell; if there are none, the
/// largest blocks (the water is then too shallow to emit at rest). `droplet_m`: a particle's volume over a cell's area.
/// `reach_count`: a droplet is spread over 4 reach_count + 1 cells per axis, with the weights of
/// shaders/coupling/splat.glsl.
SprayBlocks sprayBlocks(std::uint32_t reach_count, double droplet_m, double depth_m);

/// Returns k of p = k (rho - rho0): c0^2 over the stress ratio of the lattice.
double stiffnessOf(const core::ParticleScene& particles, const ParticleLayout& layout);

}  // namespace spindrift::sim
