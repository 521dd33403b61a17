// The weights of a surface's prediction, fitted to its samples (least squares).
#pragma once

#include "surface_predictor.h"

namespace spindrift::stream {

/// The weights that fit about samples_count samples of the plane best, spread over all of it. Each weight fits into 16
/// bits; those of frames that `history` lacks are 0.
SurfaceWeights fitWeights(const SurfacePlane& plane, const SurfaceHistory& history, std::size_t samples_count);

}  // namespace spindrift::stream
