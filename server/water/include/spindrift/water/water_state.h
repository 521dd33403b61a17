// The state of a simulation as a message, and back; its hash in logs and snapshots.
#pragma once

#include <cstdint>

#include <spindrift/core/result.h>
#include <spindrift/core/scene.h>
#include <spindrift/sim/water_sim.h>
#include <spindrift/sim_state/saved_state.h>
#include <spindrift/v1/kept_state.pb.h>

namespace spindrift::water {

v1::Side toMessage(core::Side side);
v1::StrokeTool toMessage(sim::StrokeTool tool);
sim::StrokePart toStrokePart(const v1::Stroke& stroke);
v1::WaterState toMessage(const sim::SavedState& state);

/// Error: kInvalidInput for a message that no simulation can have made.
core::Result<sim::SavedState> toSavedState(const v1::WaterState& message);

/// `state_hash_version` of what this program writes: WaterSim::stateHash().
inline constexpr std::uint32_t kStateHashVersion = 1;

/// Returns the hash of the water as `version` defines it; older versions of the program computed it from less of the
/// state. Version 0 has positions and velocities of the particles, the wave's elevation and flow, boats and the pool.
/// kInvalidInput for a version that this program does not know. Waits for the device.
core::Result<std::uint64_t> recordedHash(sim::WaterSim& water, std::uint32_t version);

}  // namespace spindrift::water
