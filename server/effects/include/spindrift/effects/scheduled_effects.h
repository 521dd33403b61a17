// Effects that the scene starts by itself: its events, rain and gusts. Pure functions of the scene and the time, so
// that they repeat with the run. Scenes with a wind sea (sea_state.h) have no gusts.
#pragma once

#include <cstdint>
#include <vector>

#include <spindrift/core/scene.h>
#include <spindrift/sim_setup/derive.h>

namespace spindrift::sim {

/// Slots for splashes and waves that rain and wind leave free for clients.
inline constexpr std::size_t kSpareSplashes = 32;
inline constexpr std::size_t kSpareCrests = 8;

/// Returns the events that are due in the tick from `from_s` on. A splash is no deeper than the water permits now; the
/// scene was checked with its first depth.
std::vector<core::Effect> dueEvents(const core::Scene& scene, double from_s, double tick_s);

/// Returns the drops and gusts that start in tick `tick` (counted from the scene's start), drops first. At most as many
/// as there are slots.
std::vector<core::Effect> stormEffects(const core::Scene& scene, const WaveLayout& wave, std::uint64_t tick,
                                       double tick_s);

}  // namespace spindrift::sim
