// The state of a simulation as plain numbers, for tests, hashes and changes of scene.
#pragma once

#include <cstdint>
#include <vector>

namespace spindrift::sim {

/// Positions and velocities 4 floats per particle (xyz + id, xyz + foam), elevations nx x nz, x fastest [m].
struct StateCopy {
  std::vector<float> position, velocity;
  std::vector<float> density_kgpm3;
  std::vector<double> elevation_m;  ///< whole units of shaders/shared/fixed_point.h, which a double holds exactly
  /// Part of elevation_m that came through x faces, in a matched layer [units]; empty in scenes without one.
  std::vector<std::int32_t> elevation_x_units;
  std::vector<float> boats;         ///< layout: shaders/shared/boats.h; every slot
  std::vector<std::uint32_t> pool;  ///< shaders/shared/pool.h; two-way scenes
  std::vector<float> flow_m2ps;     ///< 2 (9-point stencil: 4) per cell: the faces owned by the cell
};

}  // namespace spindrift::sim
