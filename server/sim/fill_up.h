// Water over a bed that has risen, in whole units. Pure functions.
#pragma once

#include <cstdint>
#include <span>

namespace spindrift::sim {

/// Still depth [units] as the shaders see it (shaders/wave/water_column.glsl): of the float, cut to whole units.
std::int64_t bedUnits(double depth_m);

enum class Lack {
  kComesFromOutside,  ///< what all cells together lack enters through the open sides
  kStays,  ///< a closed basin whose water is in its spray: the lowest cells stay below the bed until it falls back
};

struct FillUp {
  bool is_changed = false;
  std::int64_t from_outside_units = 0;  ///< what the sum of the elevations has grown by
};

/// Raises every cell whose elevation lies below its bed up to it (`elevation_units` = -`bed_units`), with water of the
/// other wet cells in proportion to what they hold. Both are n x n; a cell with a bed of 0 is dry and not looked at.
FillUp fillUp(std::span<const std::int64_t> bed_units, std::span<std::int32_t> elevation_units, Lack lack);

}  // namespace spindrift::sim
