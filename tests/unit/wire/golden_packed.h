// Golden frames in files of their own, most of them packed: a keyframe and two deltas of the surface, two frames of
// foam, and particles.
#pragma once

#include <vector>

#include "golden_cases.h"

namespace spindrift::wire {

std::vector<GoldenCase> goldenPackedSurfaces();
std::vector<GoldenCase> goldenPackedFoam();
std::vector<GoldenCase> goldenPackedParticles();
/// Planes with other numbers of samples along x and z, plain and packed (golden_rectangles.cpp).
std::vector<GoldenCase> goldenRectangles();
/// Objects in the water (golden_floaters.cpp).
std::vector<GoldenCase> goldenFloaters();

}  // namespace spindrift::wire
