// Packed particles as they stand in the stream. Shared by both directions.
#pragma once

#include <cstddef>
#include <cstdint>

namespace spindrift::codec {

inline constexpr std::uint32_t kOffsetBitsMax = 8;
/// Coordinates fit into 16 bits, cell numbers into 24.
inline constexpr std::uint32_t kCoordinateMaxCount = 1u << 16;
inline constexpr std::uint64_t kCellMaxCount = 1u << 24;
inline constexpr std::size_t kHalfSymbolCount = 256;  ///< counts of four eighths, two bits each
inline constexpr std::size_t kGapSymbolCount = 25;    ///< bits of the number of empty cells
/// So many in an eighth, or more: the rest stands by itself.
inline constexpr std::uint32_t kManyCount = 3;
/// The length of what stands by itself, at most.
inline constexpr std::uint32_t kMaxGammaBits = 23;

}  // namespace spindrift::codec
