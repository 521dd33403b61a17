// Where particles start: a lattice at rest density, with a little seeded jitter.
#pragma once

#include <cstdint>
#include <vector>

#include <spindrift/core/result.h>
#include <spindrift/core/scene.h>
#include <spindrift/gpu/context.h>
#include <spindrift/sim/derive.h>

namespace spindrift::sim {

/// 4 floats a particle: position [m] and id, layer by layer from below. The same on every machine for a seed.
std::vector<float> startingPositions(const core::Scene& scene, const ParticleLayout& layout);

/// The same after `settle_s` in which nothing happens and the particles lose their speed three times a second: a
/// lattice is no rest state of the solver, and slides into a looser order with all the energy that it has to spare.
core::Result<std::vector<float>> settledPositions(gpu::Context& ctx, const core::Scene& scene);

}  // namespace spindrift::sim
