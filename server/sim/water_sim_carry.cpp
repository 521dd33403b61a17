// WaterSim: another simulation of the same water continues where this one is.
#include <algorithm>
#include <cmath>

#include <spindrift/sim_state/resample_state.h>

#include "water_sim_parts.h"

namespace spindrift::sim {

CarriedState WaterSim::carriedState() {
  return {.scene = scene_, .derived = derived_, .time_s = time_s(), .state = copyState(), .host = hostState()};
}

core::Result<void> WaterSim::takeOver(const CarriedState& carried) {
  if (!isSameWater(carried.scene, scene_)) {
    return core::Error{core::ErrorCode::kInvalidInput,
                       "scene " + scene_.name + ": its sides, bed or parts differ, so it cannot continue from there"};
  }
  const ResampledState resampled = resampleState(carried, scene_, derived_);
  setState(resampled.state);
  if (parts_->wave) parts_->wave->setOutflow(resampled.outflow_units);
  if (const double ratio = keptFlowRatio(carried.scene, scene_); ratio != 1.0) parts_->wave->scaleFlow(ratio);
  continueWith(carried.host, static_cast<std::uint64_t>(std::llround(carried.time_s / derived_.tick_s)));
  if (parts_->wind_sea && changesWaves(carried.scene, scene_)) parts_->wind_sea->continueIn(scene_, carried.time_s);
  parts_->pressAgain();
  return {};
}

}  // namespace spindrift::sim
