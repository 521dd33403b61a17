// WaterSim: another simulation of the same water continues where this one is.
#include <algorithm>
#include <cmath>

#include "carry_state.h"
#include "water_sim_parts.h"

namespace spindrift::sim {

CarriedState WaterSim::carriedState() {
  CarriedState out{.scene = scene_, .derived = derived_, .time_s = time_s(), .state = copyState()};
  if (parts_->breakers) {
    const std::size_t cells = derived_.wave->counts().total();
    out.breaking = parts_->breakers->state().downloadVector<float>(4 * cells);
  }
  if (parts_->foam) {
    out.foam = parts_->foam->field().downloadVector<float>(4 * derived_.wave->foamCounts().total());
  }
  out.effects = parts_->effects;
  if (parts_->boats) out.boats = parts_->boats->carried();
  if (parts_->wind_sea) out.sea = parts_->wind_sea->carried();
  if (parts_->follower) {
    out.patch_x_m = parts_->follower->x_m();
    out.patch_z_m = parts_->follower->z_m();
  }
  return out;
}

core::Result<void> WaterSim::takeOver(const CarriedState& carried) {
  if (!isSameWater(carried.scene, scene_)) {
    return core::Error{core::ErrorCode::kInvalidInput,
                       "scene " + scene_.name + ": its sides, bed or parts differ, so it cannot continue from there"};
  }
  const ResampledState resampled = resampleState(carried, scene_, derived_);
  setState(resampled.state);
  if (parts_->wave) parts_->wave->setOutflow(resampled.outflow_units);
  if (parts_->breakers && !resampled.breaking.empty()) parts_->breakers->state().upload(resampled.breaking);
  if (parts_->foam && !resampled.foam.empty()) parts_->foam->field().upload(resampled.foam);
  parts_->effects = carried.effects;
  if (const double ratio = keptFlowRatio(carried.scene, scene_); ratio != 1.0) parts_->wave->scaleFlow(ratio);
  if (parts_->wind_sea) {
    parts_->wind_sea->takeOver(carried.sea);
    if (changesWaves(carried.scene, scene_)) parts_->wind_sea->continueIn(scene_, carried.time_s);
  }
  if (parts_->follower) parts_->follower->goTo(carried.patch_x_m, carried.patch_z_m);
  if (parts_->boats) {
    parts_->boats->takeOver(carried.boats);
    first_boat_id_ = carried.boats.first_id;
  }
  parts_->pressAgain();
  start_tick_ = tick_ - static_cast<std::uint64_t>(std::llround(carried.time_s / derived_.tick_s));  // modulo 2^64
  abandoned_until_tick_ = tick_;  // health in flight belongs to the start
  parts_->checkpoints->forget();
  parts_->checkpoints->save(tick_);  // confirmed by the health of the next ticks
  ++revision_;
  return {};
}

}  // namespace spindrift::sim
