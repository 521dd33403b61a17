// Neighbours of particles, counted on the host.
#pragma once

#include <array>
#include <span>

#include <spindrift/core/scene.h>
#include <spindrift/sim_setup/derive.h>

namespace spindrift::bench {

/// Sides of the box in which particles are counted.
struct CountedBox {
  double support_radius_m = 0.0;
  std::array<double, 3> side_m{};  ///< of a periodic axis; 0: not periodic
};
/// Returns the box of the particles of a scene.
CountedBox countedBox(const core::Scene& scene, const sim::Derived& derived);

/// Returns the mean number of other particles closer than the support radius; 0 without particles. `position`: 4 floats
/// per particle, finite. A periodic side is at least two support radii long.
double meanNeighbours(std::span<const float> position, const CountedBox& box);

}  // namespace spindrift::bench
