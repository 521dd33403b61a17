// Rain and gusts as effects: which drops fall and which crests start during a tick. A pure function of scene, seed
// and tick, so that a storm repeats with the run. Scenes with a wind sea (sea_state.h) have no gusts.
#pragma once

#include <cstdint>
#include <vector>

#include <spindrift/core/scene.h>
#include <spindrift/sim_setup/derive.h>

namespace spindrift::sim {

/// Slots for splashes and waves that rain and wind leave free for clients.
inline constexpr std::size_t kSpareSplashes = 32;
inline constexpr std::size_t kSpareCrests = 8;

/// Returns the effects that start in tick `tick` (counted from the scene's start), drops first. At most as many as
/// there are slots.
std::vector<core::Effect> stormEffects(const core::Scene& scene, const WaveLayout& wave, std::uint64_t tick,
                                       double tick_s);

}  // namespace spindrift::sim
