#include <spindrift/rooms/tick_meter.h>

namespace spindrift::rooms {

const TickMeter::Means& TickMeter::takeMeans(sim::WaterSim& water) {
  if (count_ == 0) return last_;
  last_.step_ms = sum_ms_ / count_;
  last_.passes.clear();
  for (const gpu::PassCost& pass : water.takePassCosts()) {
    last_.passes.push_back({pass.name, pass.total_ms / count_});
  }
  sum_ms_ = 0.0;
  count_ = 0;
  return last_;
}

}  // namespace spindrift::rooms
