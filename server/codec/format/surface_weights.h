// Weights of the known samples in a prediction. Shared by encoder and decoder.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace spindrift::codec {

/// Weights in units of 1 / 4096. Each multiplies a sum over: the same position one frame before (kBefore), its 4
/// nearest, its 4 diagonal neighbours, the 4 samples two cells away along the axes; the same position two frames before
/// and its 4 nearest and 4 diagonal neighbours; in this frame the neighbours at -x, at -z, and at both.
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
/// Number of samples along each side of a tile.
inline constexpr std::size_t kTile = 8;

}  // namespace spindrift::codec
