// Starting positions of the particles: a lattice at rest density, with a little seeded jitter.
#pragma once

#include <vector>

#include <spindrift/core/scene.h>
#include <spindrift/sim_setup/derive.h>

namespace spindrift::sim {

/// Returns 4 floats per particle: position [m] and id, layer by layer from below. The same on every machine for a given
/// seed.
std::vector<float> startingPositions(const core::Scene& scene, const ParticleLayout& layout);

}  // namespace spindrift::sim
