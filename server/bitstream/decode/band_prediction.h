// Decodes eight rows of a plane from the previous frames and the residuals.
#pragma once

#include <cstddef>
#include <cstdint>

#include <spindrift/bitstream/format/residual_format.h>
#include <spindrift/bitstream/format/surface_weights.h>

namespace spindrift::codec {

/// Pointers to the first sample of a row in the previous frame and in the one before that, with rows around them.
struct HistoryRows {
  const std::int16_t* before;
  const std::int16_t* earlier;
  std::size_t stride;
};

/// Room in a row of sums before its first and after its last sum.
inline constexpr std::size_t kSumsLeft = 8, kSumsRight = 16;

/// Sets sums[x] = 4096 * (residual + prediction from the history), rounding included, modulo 2^32, for the 8 *
/// tiles_count samples of row j of a row of tiles.
void sumHistory(const HistoryRows& history, const SurfaceWeights& weights, const ResidualGroup* tiles, std::size_t j,
                std::size_t tiles_count, std::uint32_t* sums);
/// The same without a history.
void sumResiduals(const ResidualGroup* tiles, std::size_t j, std::size_t tiles_count, std::uint32_t* sums);

/// Decodes eight rows from their sums and the row above, which is 0 for the first rows of a plane. Row j of the sums
/// and of the samples begins j strides after the first. Writes up to 7 samples before each row and 14 after it.
void predictBand(const std::uint32_t* sums, std::size_t sums_stride, const SurfaceWeights& weights, bool is_first,
                 std::int16_t* samples, std::size_t stride, std::size_t n);

}  // namespace spindrift::codec
