// The body of water that hangs together, of particles in a channel that is periodic across (z).
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <vector>

#include <spindrift/sim_setup/derive.h>

namespace spindrift::study {

/// Particles that reach each other through neighbours closer than the support radius, starting at the one nearest to
/// the foot of the wall at the start of the box. Refers to its arguments.
class ConnectedWater {
 public:
  /// `position`: four floats per particle, as in sim::StateCopy.
  ConnectedWater(const std::vector<float>& position, const sim::ParticleLayout& layout);

  /// Distance of the farthest particle from the wall. [m]
  [[nodiscard]] double edge_m() const;
  /// Volume within two support radii of the wall, over their area: the mean height of the water there. [m]
  [[nodiscard]] double columnHeight_m() const;
  /// Height over the floor of the highest particle within a support radius of the wall. [m]
  [[nodiscard]] double highestAtWall_m() const;

 private:
  using Cell = std::array<int, 2>;  ///< along x and up; the channel is a few particles wide

  [[nodiscard]] double fromWall_m(std::size_t i) const { return position_[4 * i] - layout_.min_m[0]; }
  [[nodiscard]] Cell cellOf(std::size_t i) const;
  [[nodiscard]] bool areNeighbours(std::size_t a, std::size_t b) const;
  void grow(std::size_t first);

  const std::vector<float>& position_;
  const sim::ParticleLayout& layout_;
  std::map<Cell, std::vector<std::size_t>> cells_;
  std::vector<std::size_t> members_;
};

}  // namespace spindrift::study
