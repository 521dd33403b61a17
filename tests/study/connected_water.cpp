#include "connected_water.h"

#include <algorithm>
#include <cmath>

namespace spindrift::study {

ConnectedWater::ConnectedWater(const std::vector<float>& position, const sim::ParticleLayout& layout)
    : position_(position), layout_(layout) {
  for (std::size_t i = 0; i < position.size() / 4; ++i) cells_[cellOf(i)].push_back(i);
  std::size_t foot = 0;
  const auto fromFoot = [&](std::size_t i) { return fromWall_m(i) + position[4 * i + 1] - layout.min_m[1]; };
  for (std::size_t i = 1; i < position.size() / 4; ++i) {
    if (fromFoot(i) < fromFoot(foot)) foot = i;
  }
  grow(foot);
}

double ConnectedWater::edge_m() const {
  double x_m = 0.0;
  for (const std::size_t i : members_) x_m = std::max(x_m, fromWall_m(i));
  return x_m + 0.5 * layout_.spacing_m;
}

double ConnectedWater::columnHeight_m() const {
  const double spacing_m = layout_.spacing_m;
  const double length_m = 2 * layout_.support_radius_m;
  double count = 0.0;
  for (const std::size_t i : members_) {
    // The share of the particle's own spacing that lies before the end.
    count += std::clamp((length_m - fromWall_m(i)) / spacing_m + 0.5, 0.0, 1.0);
  }
  return count * std::pow(spacing_m, 3) / (length_m * (layout_.max_m[2] - layout_.min_m[2]));
}

double ConnectedWater::highestAtWall_m() const {
  double y_m = 0.0;
  for (const std::size_t i : members_) {
    if (fromWall_m(i) < layout_.support_radius_m) y_m = std::max(y_m, position_[4 * i + 1] + layout_.band_m);
  }
  return y_m + 0.5 * layout_.spacing_m;
}

ConnectedWater::Cell ConnectedWater::cellOf(std::size_t i) const {
  return {static_cast<int>(std::floor(fromWall_m(i) / layout_.support_radius_m)),
          static_cast<int>(std::floor((position_[4 * i + 1] - layout_.min_m[1]) / layout_.support_radius_m))};
}

bool ConnectedWater::areNeighbours(std::size_t a, std::size_t b) const {
  double square_m2 = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double d_m = position_[4 * a + axis] - position_[4 * b + axis];
    const double width_m = layout_.max_m[2] - layout_.min_m[2];
    if (axis == 2) d_m -= width_m * std::round(d_m / width_m);  // periodic across
    square_m2 += d_m * d_m;
  }
  return square_m2 < layout_.support_radius_m * layout_.support_radius_m;
}

void ConnectedWater::grow(std::size_t first) {
  std::vector<bool> is_member(position_.size() / 4, false);
  is_member[first] = true;
  members_ = {first};
  for (std::size_t next = 0; next < members_.size(); ++next) {
    const Cell at = cellOf(members_[next]);
    for (int dx = -1; dx <= 1; ++dx) {
      for (int dy = -1; dy <= 1; ++dy) {
        const auto found = cells_.find(Cell{at[0] + dx, at[1] + dy});
        if (found == cells_.end()) continue;
        for (const std::size_t i : found->second) {
          if (is_member[i] || !areNeighbours(members_[next], i)) continue;
          is_member[i] = true;
          members_.push_back(i);
        }
      }
    }
  }
}

}  // namespace spindrift::study
