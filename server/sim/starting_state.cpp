#include "starting_state.h"

namespace spindrift::sim {
namespace {

/// SplitMix64 (Steele, Lea & Flood 2014): small, seedable, the same everywhere, which <random>'s distributions are not.
class SplitMix64 {
 public:
  explicit SplitMix64(std::uint64_t seed) : state_(seed) {}
  /// Uniform in [-1, 1).
  double symmetric() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ull);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    z ^= z >> 31;
    return static_cast<double>(z >> 11) * 0x1.0p-52 - 1.0;
  }

 private:
  std::uint64_t state_;
};

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

}  // namespace spindrift::sim
