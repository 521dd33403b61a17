// Eight rows of a plane from what the frames before say and what was left over.
#pragma once

#include <cstddef>
#include <cstdint>

#include "format/residual_format.h"
#include "format/surface_weights.h"

namespace spindrift::codec {

/// Rows of samples around the first of a row, in the frame before and in the one before that.
struct HistoryRows {
  const std::int16_t* before;
  const std::int16_t* earlier;
  std::size_t stride;
};

/// What a row of sums has room for before its first and behind its last sum.
inline constexpr std::size_t kSumsLeft = 8, kSumsRight = 16;

/// sums[x] = 4096 * residual + what the history says times 4096, rounding included, modulo 2^32; for 8 * tiles_count
/// samples of row j of a row of tiles.
void sumHistory(const HistoryRows& history, const SurfaceWeights& weights, const ResidualGroup* tiles, std::size_t j,
                std::size_t tiles_count, std::uint32_t* sums);
/// The same where there is no history.
void sumResiduals(const ResidualGroup* tiles, std::size_t j, std::size_t tiles_count, std::uint32_t* sums);

/// Eight rows from their sums and the row above, which for the first rows of a plane is 0. Row j of the sums and of the
/// samples begins j strides behind the first. Writes up to 7 samples before each row and 14 behind it.
void predictBand(const std::uint32_t* sums, std::size_t sums_stride, const SurfaceWeights& weights, bool is_first,
                 std::int16_t* samples, std::size_t stride, std::size_t n);

}  // namespace spindrift::codec
