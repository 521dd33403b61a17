#include "neighbours.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <spindrift/sim_setup/scene_parts.h>

namespace spindrift::bench {

CountedBox countedBox(const core::Scene& scene, const sim::Derived& derived) {
  const sim::ParticleLayout& layout = *derived.particles;
  const bool two_way = sim::isTwoWay(scene);
  const auto is_periodic = [](core::Boundary boundary) { return boundary == core::Boundary::kPeriodic; };
  const std::array<bool, 3> periodic = {
      two_way ? sim::isPeriodicX(*scene.wave) : is_periodic(scene.particles->boundary_x), scene.particles->periodic_y,
      two_way ? sim::isPeriodicZ(*scene.wave) : is_periodic(scene.particles->boundary_z)};
  CountedBox box{.support_radius_m = layout.support_radius_m};
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (periodic[axis]) box.side_m[axis] = layout.max_m[axis] - layout.min_m[axis];
  return box;
}

double meanNeighbours(std::span<const float> position, const CountedBox& box) {
  const std::size_t count = position.size() / 4;
  if (count == 0) return 0.0;
  const double h = box.support_radius_m;
  // Cells of at least h, at most 128 per axis; along a periodic axis a whole number of them.
  std::array<double, 3> low{}, cell_m{};
  std::array<int, 3> n{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double least = std::numeric_limits<double>::infinity();
    double most = -least;
    for (std::size_t i = 0; i < count; ++i) {
      least = std::min<double>(least, position[4 * i + axis]);
      most = std::max<double>(most, position[4 * i + axis]);
    }
    const double side_m = box.side_m[axis] > 0 ? box.side_m[axis] : most - least + 1e-6 * h;
    low[axis] = least;
    n[axis] = std::clamp(static_cast<int>(side_m / h), 1, 128);
    cell_m[axis] = side_m / n[axis];
  }
  const auto cellOf = [&](std::size_t i, std::size_t axis) {
    return std::clamp(static_cast<int>((position[4 * i + axis] - low[axis]) / cell_m[axis]), 0, n[axis] - 1);
  };
  const auto flat = [&](int x, int y, int z) {
    return static_cast<std::size_t>(x) +
           static_cast<std::size_t>(n[0]) *
               (static_cast<std::size_t>(y) + static_cast<std::size_t>(n[1]) * static_cast<std::size_t>(z));
  };
  std::vector<std::vector<std::size_t>> members(flat(n[0] - 1, n[1] - 1, n[2] - 1) + 1);
  for (std::size_t i = 0; i < count; ++i) members[flat(cellOf(i, 0), cellOf(i, 1), cellOf(i, 2))].push_back(i);
  /// Cells beside a cell along an axis, each once.
  const auto beside = [&](int cell, std::size_t axis) {
    std::vector<int> out;
    for (int d = -1; d <= 1; ++d) {
      int at = cell + d;
      if (box.side_m[axis] > 0) at = (at + n[axis]) % n[axis];
      if (at >= 0 && at < n[axis] && std::ranges::find(out, at) == out.end()) out.push_back(at);
    }
    return out;
  };
  std::size_t pairs = 0;
  for (std::size_t i = 0; i < count; ++i) {
    for (const int z : beside(cellOf(i, 2), 2)) {
      for (const int y : beside(cellOf(i, 1), 1)) {
        for (const int x : beside(cellOf(i, 0), 0)) {
          for (const std::size_t j : members[flat(x, y, z)]) {
            double r2 = 0.0;
            for (std::size_t axis = 0; axis < 3; ++axis) {
              double d = double{position[4 * i + axis]} - position[4 * j + axis];
              if (box.side_m[axis] > 0) d -= box.side_m[axis] * std::round(d / box.side_m[axis]);
              r2 += d * d;
            }
            pairs += r2 < h * h && i != j ? 1 : 0;
          }
        }
      }
    }
  }
  return static_cast<double>(pairs) / static_cast<double>(count);
}

}  // namespace spindrift::bench
