// Format of packed particles in the stream. Shared by encoder and decoder.
#pragma once

#include <cstddef>
#include <cstdint>

namespace spindrift::codec {

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
