// The packed surface's golden frames: three in a row, the first of which is whole.
#pragma once

#include <vector>

#include "golden_cases.h"

namespace spindrift::stream {

std::vector<GoldenCase> goldenPackedSurfaces();

}  // namespace spindrift::stream
