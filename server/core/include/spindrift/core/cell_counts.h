// The cells of the water's grid: square ones, as many along x and along z as the scene wants.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace spindrift::core {

/// Numbers of cells, or of samples, along x and along z. Planes of them are stored row by row, x fastest.
struct CellCounts {
  std::uint32_t x = 0;
  std::uint32_t z = 0;

  [[nodiscard]] constexpr std::size_t total() const { return std::size_t{x} * z; }
  bool operator==(const CellCounts&) const = default;
};

/// Largest number of cells of a water. Not every device has buffers for so many.
inline constexpr std::size_t kWaveMaxCellCount = std::size_t{2048} * 2048;
/// Largest number of cells along an axis.
inline constexpr std::uint32_t kWaveMaxSideCount = 4096;

/// The grid of a rectangle of water.
struct WaveCells {
  CellCounts count;
  double cell_m = 0.0;
  double length_m = 0.0;  ///< along x
  double width_m = 0.0;   ///< along z: count.z * cell_m
};

/// Returns the grid of water that is `length_m` long, in `count_x` cells, and about `width_m` wide: as many whole cells
/// as are nearest, at least one. A width of 0 is that of a square. Preconditions: count_x > 0, length_m > 0.
[[nodiscard]] inline WaveCells waveCellsOf(std::uint32_t count_x, double length_m, double width_m) {
  WaveCells out{{count_x, count_x}, length_m / count_x, length_m, length_m};
  if (width_m <= 0.0 || width_m == length_m) return out;
  const double wanted = std::clamp(std::round(width_m / out.cell_m), 1.0, 1e9);
  out.count.z = static_cast<std::uint32_t>(wanted);
  // A width that fits stays as it was given.
  const double whole_m = wanted * out.cell_m;
  out.width_m = std::abs(whole_m - width_m) <= 1e-9 * width_m ? width_m : whole_m;
  return out;
}

/// Returns whether the width is a whole number of cells.
[[nodiscard]] inline bool widthFits(const WaveCells& cells, double width_m) {
  constexpr double kTolerance_cells = 1e-3;  // of numbers that people write
  return width_m <= 0.0 || std::abs(cells.width_m - width_m) <= kTolerance_cells * cells.cell_m;
}

}  // namespace spindrift::core
