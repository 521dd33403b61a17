// The packed golden frames: three surfaces in a row, the first of which is whole, likewise two of foam, and particles.
#pragma once

#include <vector>

#include "golden_cases.h"

namespace spindrift::wire {

std::vector<GoldenCase> goldenPackedSurfaces();
std::vector<GoldenCase> goldenPackedFoam();
std::vector<GoldenCase> goldenPackedParticles();

}  // namespace spindrift::wire
