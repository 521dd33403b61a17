// Whether a device can hold a scene, found out before any of its buffers is made.
#pragma once

#include <spindrift/core/result.h>
#include <spindrift/core/scene.h>
#include <spindrift/gpu/context.h>
#include <spindrift/sim_setup/derive.h>

namespace spindrift::sim {

/// Errors name the field, its value, what the device takes and what to do: kInvalidInput for a buffer that is larger
/// than one buffer of the device can be, kUnavailable for buffers that together are larger than the memory that is
/// free.
core::Result<void> fitsDevice(const gpu::Context& ctx, const core::Scene& scene, const Derived& derived);

}  // namespace spindrift::sim
