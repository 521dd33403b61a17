#include "starting_state.h"

#include <spindrift/sim/water_sim.h>
#include <spindrift/sim_setup/random.h>

namespace spindrift::sim {
namespace {

constexpr double kCalmInterval_s = 1.0;

}  // namespace

std::vector<float> startingPositions(const core::Scene& scene, const ParticleLayout& layout) {
  SplitMix64 random(scene.seed);
  const double jitter_m = scene.particles->jitter_ratio * layout.spacing_m;
  std::vector<float> out;
  out.reserve(std::size_t{layout.count} * 4);
  std::uint32_t id = 0;
  for (std::uint32_t y = 0; y < layout.layers_count; ++y) {
    for (std::uint32_t z = 0; z < layout.columns_z_count; ++z) {
      for (std::uint32_t x = 0; x < layout.columns_x_count; ++x) {
        out.push_back(
            static_cast<float>(layout.min_m[0] + (x + 0.5) * layout.pitch_x_m + jitter_m * random.symmetric()));
        out.push_back(static_cast<float>(-layout.band_m + layout.layer_heights_m[y] + jitter_m * random.symmetric()));
        out.push_back(
            static_cast<float>(layout.min_m[2] + (z + 0.5) * layout.pitch_z_m + jitter_m * random.symmetric()));
        out.push_back(static_cast<float>(id++));
      }
    }
  }
  return out;
}

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
