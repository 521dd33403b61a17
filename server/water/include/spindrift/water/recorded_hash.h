// State hashes in logs and snapshots, which older versions of the program computed from less of the state.
#pragma once

#include <cstdint>

#include <spindrift/core/result.h>
#include <spindrift/sim/water_sim.h>

namespace spindrift::water {

/// `state_hash_version` of what this program writes: WaterSim::stateHash().
inline constexpr std::uint32_t kStateHashVersion = 1;

/// Returns the hash of the water as `version` defines it. Version 0 has positions and velocities of the particles, the
/// wave's elevation and flow, boats and the pool. kInvalidInput for a version that this program does not know. Waits
/// for the device.
core::Result<std::uint64_t> recordedHash(sim::WaterSim& water, std::uint32_t version);

}  // namespace spindrift::water
