// The weights of a surface's prediction, fitted to its samples (least squares).
#pragma once

#include "surface_predictor.h"

namespace spindrift::codec {

/// The weights that fit some 4,096 samples of the plane best, spread over all of it. Each weight fits into 16 bits;
/// those of frames that `history` lacks are 0.
SurfaceWeights fitWeights(const SurfacePlane& plane, const SurfaceHistory& history);

}  // namespace spindrift::codec
