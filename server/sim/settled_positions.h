// Starting positions of particles that have come to rest.
#pragma once

#include <vector>

#include <spindrift/core/result.h>
#include <spindrift/core/scene.h>
#include <spindrift/gpu/context.h>

namespace spindrift::sim {

/// Returns startingPositions() after `settle_s` without events, in which once per second all speeds are set to zero: a
/// lattice is not the solver's state of rest, and releases its surplus energy when it slides into a looser order.
core::Result<std::vector<float>> settledPositions(gpu::Context& ctx, const core::Scene& scene);

}  // namespace spindrift::sim
