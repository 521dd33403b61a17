// Starting positions of the particles: a lattice at rest density, with a little seeded jitter.
#pragma once

#include <cstdint>
#include <vector>

#include <spindrift/core/result.h>
#include <spindrift/core/scene.h>
#include <spindrift/gpu/context.h>
#include <spindrift/sim_setup/derive.h>

namespace spindrift::sim {

/// 4 floats per particle: position [m] and id, layer by layer from below. The same on every machine for a given seed.
std::vector<float> startingPositions(const core::Scene& scene, const ParticleLayout& layout);

/// The same after `settle_s` without events, in which once per second all speeds are set to zero: a lattice is
/// not the solver's state of rest, and releases its surplus energy when it slides into a looser order.
core::Result<std::vector<float>> settledPositions(gpu::Context& ctx, const core::Scene& scene);

}  // namespace spindrift::sim
