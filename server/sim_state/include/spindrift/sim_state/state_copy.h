// The state of a simulation as plain numbers, for tests and changes of scene: the buffers that are declared as carried
// (state_buffer.h).
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
  std::vector<float> breaking;      ///< 4 per wave cell, as BREAKING; empty in scenes without
  std::vector<float> foam;          ///< 4 per foam sample, as FOAM_FIELD; empty in scenes without

  bool operator==(const StateCopy&) const = default;

  /// Calls `visit` with the name of a buffer and the array that has its words, for all except "elevation".
  template <typename Copy, typename Visit>
  static void forEachArray(Copy& copy, Visit visit) {
    visit("position", copy.position);
    visit("velocity", copy.velocity);
    visit("pool", copy.pool);
    visit("boats", copy.boats);
    visit("flow", copy.flow_m2ps);
    visit("elevation from x faces", copy.elevation_x_units);
    visit("breaking", copy.breaking);
    visit("foam", copy.foam);
  }
};

}  // namespace spindrift::sim
