// How passes share their work among a device's invocations.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <shared/groups.h>

namespace spindrift::gpu {

/// Preprocessor names and values put before the shader's first line.
using Defines = std::vector<std::pair<std::string, std::string>>;

/// Shares of one invocation, by class of device; shaders/shared/groups.h says what each means and has the values of a
/// CPU. Results do not depend on it, bit for bit.
struct Tuning {
  std::uint32_t reduce_items = REDUCE_ITEMS;
  std::uint32_t dispersion_columns = DISPERSION_COLUMNS;
  std::uint32_t dispersion_strip = DISPERSION_STRIP;

  /// As every shader gets it.
  [[nodiscard]] Defines defines() const {
    return {{"REDUCE_ITEMS", std::to_string(reduce_items)},
            {"DISPERSION_COLUMNS", std::to_string(dispersion_columns)},
            {"DISPERSION_STRIP", std::to_string(dispersion_strip)}};
  }
};

/// Found on an NVIDIA H200 (docs/performance.md, On a GPU).
inline constexpr Tuning kHardwareTuning{.reduce_items = 16, .dispersion_columns = 2, .dispersion_strip = 4};

}  // namespace spindrift::gpu
