// SplitMix64 (Steele, Lea & Flood 2014): small, seedable, and the same on every platform, unlike the distributions of
// <random>.
#pragma once

#include <cstdint>

namespace spindrift::core {

class SplitMix64 {
 public:
  explicit SplitMix64(std::uint64_t seed) : state_(seed) {}
  /// Returns a uniform number in [0, 1).
  double unit() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ull);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    z ^= z >> 31;
    return static_cast<double>(z >> 11) * 0x1.0p-53;
  }
  /// Returns a uniform number in [-1, 1).
  double symmetric() { return 2.0 * unit() - 1.0; }

 private:
  std::uint64_t state_;
};

}  // namespace spindrift::core
