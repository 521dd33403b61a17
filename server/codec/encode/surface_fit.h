// The weights of a surface's prediction, fitted to its samples (least squares).
#pragma once

#include "surface_predictor.h"

namespace spindrift::codec {

/// Returns the weights that fit best for some 4,096 samples, spread over the whole plane. Each weight fits into 16
/// bits; those of frames that `history` lacks are 0.
SurfaceWeights fitWeights(const SurfacePlane& plane, const SurfaceHistory& history);

}  // namespace spindrift::codec
