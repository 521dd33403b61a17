// Another number of particles for water in motion: a fresh lattice in place of the old particles, with their motion.
#pragma once

#include <spindrift/core/scene.h>
#include <spindrift/sim/derive.h>
#include <spindrift/sim/prepared_scene.h>

namespace spindrift::sim {

/// The lattice of `after`, in coupled scenes lifted with the surface as it is in `state`. Velocity and foam are the
/// Shepard mean of the old particles within their support radius (sum of W v over sum of W, with the old kernel), zero
/// where there were none: no faster than the fastest, no kinetic energy beyond the old one's of the same mass. Values
/// that are not finite are left out. O(count).
RelaidParticles relayParticles(const core::Scene& scene, const Derived& before, const StateCopy& state,
                               const ParticleLayout& after);

}  // namespace spindrift::sim
