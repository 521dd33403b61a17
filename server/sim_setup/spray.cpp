
#include <algorithm>
#include <cmath>

#include <spindrift/sim_setup/spray.h>

namespace spindrift::sim {
namespace {

constexpr double kLargestTaken = 0.5;  ///< of the depth
constexpr std::uint32_t kLargestBlock = 16;

double chooseThree(int x) {
  return x < 3 ? 0.0 : x * (x - 1.0) * (x - 2.0) / 6.0;
}

/// The same as splatWeight() of shaders/coupling/splat.glsl.
double weight(int offset, int reach) {
  const int k = 2 * reach - std::abs(offset);
  if (k < 0) return 0.0;
  return (chooseThree(k + 3) - 4 * chooseThree(k + 2 - reach)) / std::pow(reach + 1.0, 4);
}

/// Largest sum of weights on one axis if each block of `block` cells holds one particle, at any position in it.
double largestSum(int reach, int block) {
  double largest = 0.0;
  for (int shift = 0; shift < block; ++shift) {
    double sum = 0.0;
    for (int first = -2 * reach - shift; first <= 2 * reach; first += block) {
      double most = 0.0;
      for (int offset = first; offset < first + block; ++offset) most = std::max(most, weight(offset, reach));
      sum += most;
    }
    largest = std::max(largest, sum);
  }
  return largest;
}

}  // namespace

SprayBlocks sprayBlocks(std::uint32_t reach_count, double droplet_m, double depth_m) {
  SprayBlocks out;
  for (std::uint32_t block = 1;; block *= 2) {
    const double sum = largestSum(static_cast<int>(reach_count), static_cast<int>(block));
    out = {block, sum * sum};
    if (out.taken_ratio * droplet_m <= kLargestTaken * depth_m || block == kLargestBlock) return out;
  }
}

}  // namespace spindrift::sim
