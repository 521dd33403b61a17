// Where particles start: a lattice at rest density, with a little seeded jitter.
#pragma once

#include <cstdint>
#include <vector>

#include <spindrift/core/scene.h>
#include <spindrift/sim/derive.h>

namespace spindrift::sim {

/// 4 floats a particle: position [m] and id, layer by layer from below. The same on every machine for a seed.
std::vector<float> startingPositions(const core::Scene& scene, const ParticleLayout& layout);

}  // namespace spindrift::sim
