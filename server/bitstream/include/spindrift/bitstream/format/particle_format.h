// Format of packed particles in the stream. Shared by encoder and decoder.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace spindrift::codec {

/// Number of cells along x, y, z; the linear index of a cell is (z * cells x + x) * cells y + y, so that a column is
/// contiguous, as in the simulation.
struct CellGrid {
  std::array<std::uint32_t, 3> cells_count{};
  std::uint32_t offset_bits = 5;  ///< a cell's side is 2^offset_bits quanta; 1..8

  [[nodiscard]] std::uint64_t totalCount() const {
    return std::uint64_t{cells_count[0]} * cells_count[1] * cells_count[2];
  }
};

inline constexpr std::uint32_t kOffsetBitsMax = 8;
/// Coordinates have at most 16 bits, cell numbers 24.
inline constexpr std::uint32_t kCoordinateMaxCount = 1u << 16;
inline constexpr std::uint64_t kCellMaxCount = 1u << 24;
inline constexpr std::size_t kHalfSymbolCount = 256;  ///< counts of four eighths, two bits each
inline constexpr std::size_t kGapSymbolCount = 25;    ///< bits of the number of empty cells
/// This count means "this many or more" in an eighth; the rest is coded separately.
inline constexpr std::uint32_t kManyCount = 3;
/// Largest length of a separately coded rest.
inline constexpr std::uint32_t kMaxGammaBits = 23;

}  // namespace spindrift::codec
