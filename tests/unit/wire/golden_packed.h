// The packed golden frames: a keyframe and two deltas of the surface, two frames of foam, and particles.
#pragma once

#include <vector>

#include "golden_cases.h"

namespace spindrift::wire {

std::vector<GoldenCase> goldenPackedSurfaces();
std::vector<GoldenCase> goldenPackedFoam();
std::vector<GoldenCase> goldenPackedParticles();

}  // namespace spindrift::wire
