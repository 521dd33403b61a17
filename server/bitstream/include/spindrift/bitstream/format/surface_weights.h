// Planes and the weights of the known samples in a prediction. Shared by encoder and decoder.
#pragma once

#include <algorithm>
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

/// Number of rows and columns on each side of a plane that repeat its outermost samples.
inline constexpr std::size_t kBorder = 2;

/// Fills them. `first`: sample 0 of row 0.
inline void fillBorder(std::int16_t* first, std::size_t nx, std::size_t nz, std::size_t stride) {
  for (std::size_t z = 0; z < nz; ++z) {
    std::int16_t* const r = first + z * stride;
    r[-1] = r[-2] = r[0];
    r[nx] = r[nx + 1] = r[nx - 1];
  }
  std::int16_t *const top = first - kBorder, *const bottom = top + (nz - 1) * stride;
  for (std::size_t k = 1; k <= kBorder; ++k) {
    std::copy_n(top, nx + 2 * kBorder, top - k * stride);
    std::copy_n(bottom, nx + 2 * kBorder, bottom + k * stride);
  }
}

}  // namespace spindrift::codec
