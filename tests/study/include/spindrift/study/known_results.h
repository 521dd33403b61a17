// How far each fidelity level is from theory or experiment: accuracy cases whose cells and ticks follow the levels.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include <spindrift/core/result.h>
#include <spindrift/gpu/context.h>

namespace spindrift::study {

/// Factors of a fidelity level relative to BALANCED, as in scene/fidelity.cpp.
struct LevelScale {
  const char* name;
  double cells;      ///< on the wave's cells per length
  double particles;  ///< on particles per length
  double ticks;      ///< on the tick rate
};
inline constexpr std::array<LevelScale, 4> kLevelScales = {
    {{"draft", 0.5, 0.7, 1.0}, {"balanced", 1.0, 1.0, 1.0}, {"fine", 1.5, 1.7, 1.0}, {"reference", 2.5, 2.2, 2.0}}};

struct KnownResult {
  std::string name;    ///< the measured error, and the cells at BALANCED
  std::string source;  ///< source of the right value
  std::function<core::Result<double>(gpu::Context& ctx, const LevelScale& level)> error_ratio;
};

/// Returns all in the order of the table.
const std::vector<KnownResult>& knownResults();

}  // namespace spindrift::study
