// Refills cells after the bed has risen, in whole units. Pure functions.
#pragma once

#include <cstdint>
#include <span>

namespace spindrift::sim {

/// Returns the still depth [units] as the shaders compute it (shaders/wave/water_column.glsl): the depth as float, cut
/// to whole units.
std::int64_t bedUnits(double depth_m);

enum class Lack {
  kComesFromOutside,  ///< the missing water enters through the open sides
  kStays,  ///< closed basin with much of its water in spray: the lowest cells stay below the bed until it falls back
};

struct FillUp {
  bool is_changed = false;
  std::int64_t from_outside_units = 0;  ///< increase of the sum of the elevations
};

/// Raises each cell whose elevation is below its bed to the bed (`elevation_units` = -`bed_units`). The water is taken
/// from the other wet cells, in proportion to their water. Both spans are nx x nz; a cell with a bed of 0 is dry and
/// ignored.
FillUp fillUp(std::span<const std::int64_t> bed_units, std::span<std::int32_t> elevation_units, Lack lack);

}  // namespace spindrift::sim
