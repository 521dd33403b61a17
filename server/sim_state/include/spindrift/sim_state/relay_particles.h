// Lays out particles at the start, and another number of them in moving water: a new lattice that takes over the motion
// of the old particles.
#pragma once

#include <vector>

#include <spindrift/core/scene.h>
#include <spindrift/sim_setup/derive.h>
#include <spindrift/sim_state/carried_state.h>

namespace spindrift::sim {

/// Returns the starting positions, a lattice at rest density with a little seeded jitter: 4 floats per particle,
/// position [m] and id, layer by layer from below. The same on every machine for a given seed.
std::vector<float> startingPositions(const core::Scene& scene, const ParticleLayout& layout);

/// Positions and velocities, 4 floats per particle (x, y, z, id; x, y, z, foam), as in device memory.
struct RelaidParticles {
  std::vector<float> position, velocity;
};

/// Returns the lattice of `after`; in coupled scenes it is lifted with the surface of `state`. Velocity and foam are
/// the Shepard mean of the old particles within their support radius (sum of W v over sum of W, with the old kernel),
/// zero where no old particle is near: so no particle is faster than the fastest old one, and the kinetic energy of the
/// same mass does not grow. Values that are not finite are left out. O(count).
RelaidParticles relayParticles(const core::Scene& scene, const Derived& before, const StateCopy& state,
                               const ParticleLayout& after);

/// The same for a box of particles alone, whose water may have left its starting position: of the lattice points of
/// `after` over the whole box, those with the most old water around them (sum of W), as many as `after` has particles.
/// So the water keeps its position and shape to within about a spacing, and its volume as mass. O(lattice points).
RelaidParticles refillParticles(const core::Scene& scene, const Derived& before, const StateCopy& state,
                                const ParticleLayout& after);

}  // namespace spindrift::sim
