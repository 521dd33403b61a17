#include <spindrift/core/random.h>
#include <spindrift/sim_state/starting_positions.h>

namespace spindrift::sim {

std::vector<float> startingPositions(const core::Scene& scene, const ParticleLayout& layout) {
  core::SplitMix64 random(scene.seed);
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

}  // namespace spindrift::sim
