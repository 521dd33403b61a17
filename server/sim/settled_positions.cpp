#include "settled_positions.h"

#include <spindrift/sim/water_sim.h>

namespace spindrift::sim {
namespace {

constexpr double kCalmInterval_s = 1.0;

}  // namespace

core::Result<std::vector<float>> settledPositions(gpu::Context& ctx, const core::Scene& scene) {
  core::Scene quiet = scene;
  quiet.events.clear();
  quiet.storm.reset();
  quiet.wave_makers.clear();
  quiet.particles->settle_s = 0;
  auto water = WaterSim::create(ctx, quiet);
  if (!water) return water.error();
  double calm_at_s = kCalmInterval_s;
  while ((*water)->time_s() < scene.particles->settle_s) {
    (*water)->step();
    if ((*water)->deviceError()) return *(*water)->deviceError();
    if ((*water)->time_s() < calm_at_s) continue;
    calm_at_s += kCalmInterval_s;
    StateCopy state = (*water)->copyState();
    state.velocity.assign(state.velocity.size(), 0.0f);
    (*water)->setState(state);
  }
  return (*water)->copyState().position;
}

}  // namespace spindrift::sim
