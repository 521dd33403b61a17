// Predicts one row of a surface.
#pragma once

#include <cstdint>
#include <span>

#include "surface_predictor.h"

namespace spindrift::codec {

/// Computes the residuals of row z of a known plane. `sums` is scratch memory.
void residualsOfRow(const SurfacePlane& plane, const SurfaceHistory& history, const SurfaceWeights& weights,
                    std::size_t z, std::span<std::int32_t> sums, std::span<std::int16_t> out);

/// Multiplication and addition that wrap around.
inline std::int32_t wrappingTimes(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) * static_cast<std::uint32_t>(b));
}
inline std::int32_t wrappingSum(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) + static_cast<std::uint32_t>(b));
}

/// Neighbours in this frame that are already decoded.
struct KnownSamples {
  std::int32_t west, north, north_west;
};
inline std::int16_t predictionOf(std::int32_t from_history, const KnownSamples& known, const SurfaceWeights& weights) {
  using W = SurfaceWeights;
  const std::int32_t sum = wrappingSum(wrappingSum(from_history, wrappingTimes(weights.of[W::kWest], known.west)),
                                       wrappingSum(wrappingTimes(weights.of[W::kNorth], known.north),
                                                   wrappingTimes(weights.of[W::kNorthWest], known.north_west)));
  return static_cast<std::int16_t>(sum >> kWeightBits);
}

}  // namespace spindrift::codec
