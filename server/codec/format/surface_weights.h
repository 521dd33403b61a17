// How much each known sample counts for in a prediction. Shared by both directions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace spindrift::codec {

/// Weights in units of 1 / 4096, of sums over: the place one frame before (kBefore), its 4 nearest, its 4 diagonal
/// neighbours, the 4 two cells away along the axes; the place two frames before and its 4 nearest and 4 diagonal
/// neighbours; in this frame the neighbours at -x, at -z, and at both.
struct SurfaceWeights {
  enum Term : std::size_t {
    kBefore,
    kBeforeNearest,
    kBeforeDiagonal,
    kBeforeFar,
    kEarlier,
    kEarlierNearest,
    kEarlierDiagonal,
    kWest,
    kNorth,
    kNorthWest,
    kTermCount
  };
  std::array<std::int32_t, kTermCount> of{};
};
inline constexpr int kWeightBits = 12;
/// A plane is coded in tiles of so many samples along each side.
inline constexpr std::size_t kTile = 8;

}  // namespace spindrift::codec
