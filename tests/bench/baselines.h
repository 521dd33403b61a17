// Existing codecs for comparison: `spindrift-bench --suite codec` prints them beside the stream's own. zstd,
// meshoptimizer and Draco are used if they were installed at build time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace spindrift::bench {

struct BaselineResult {
  std::size_t bytes = 0;
  double encode_ms = 0.0;
  double decode_ms = 0.0;
  bool is_exact = false;               ///< the decoded data equals the input
  std::vector<float> position_m = {};  ///< only if not exact: decoded positions in any order, x y z
};

BaselineResult deflate(std::span<const std::uint32_t> words);
/// Level 3. nullopt here and below: not installed.
std::optional<BaselineResult> zstd(std::span<const std::uint32_t> words);
/// Codes vertices of four numbers: x, y, z in quanta and 0.
std::optional<BaselineResult> meshoptimizer(std::span<const std::uint16_t> places);
/// Codes a point cloud with Draco's kd-tree, quantized to `quantum_m` or finer, speed 5.
std::optional<BaselineResult> draco(std::span<const float> position_m, double quantum_m);

}  // namespace spindrift::bench
