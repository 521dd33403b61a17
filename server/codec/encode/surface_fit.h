// The weights of a surface's prediction, fitted to its samples (weighted least squares).
#pragma once

#include "surface_predictor.h"

namespace spindrift::codec {

/// Returns the weights that fit best for some 4,096 samples, spread over the whole plane. Each weight fits into 16
/// bits; those of frames that `history` lacks are 0. `guess`: weights of the frame before, or null. They tell where the
/// prediction is bad, at breakers and hulls; there samples count less, since a tile costs the logarithm of its
/// residuals and not their square. Planes of fewer than kGuessedResolution samples per side have too few positions.
SurfaceWeights fitWeights(const SurfacePlane& plane, const SurfaceHistory& history, const SurfaceWeights* guess);

inline constexpr std::size_t kGuessedResolution = 64;

}  // namespace spindrift::codec
