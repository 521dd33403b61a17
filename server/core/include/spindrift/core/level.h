// Levels of detail, for clients that cannot receive the full data. The client chooses a level, or the server adapts it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace spindrift::core {

/// Coarsest first. The values are the indices of all arrays by level. The levels below kFull, called the reduced
/// levels, limit the size and the rate of the frames.
enum class Level : std::uint8_t { kCoarse, kMedium, kFine, kFull };
inline constexpr std::array kLevels = {Level::kCoarse, Level::kMedium, Level::kFine, Level::kFull};
inline constexpr std::size_t kLevelCount = kLevels.size();

constexpr std::size_t indexOf(Level level) {
  return static_cast<std::size_t>(level);
}

/// Limits of one level. The defaults are no limit.
struct LevelBudget {
  /// Samples along each side; the foam has half as many.
  std::uint32_t surface_resolution_count = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t particle_count = std::numeric_limits<std::uint32_t>::max();
  double rate_hz = std::numeric_limits<double>::infinity();
};
/// Indexed by Level; kFull has no limit.
inline constexpr std::array<LevelBudget, kLevelCount> kLevelBudgets{
    {{128, 8192, 20.0}, {256, 32768, 30.0}, {512, 131072, 30.0}, {}}};

constexpr const LevelBudget& budgetOf(Level level) {
  return kLevelBudgets[indexOf(level)];
}

/// Number of levels that downsample a layer. They are the lowest ones; every other level has the data of kFull.
struct ReducedCounts {
  std::uint32_t planes = 0;  ///< surface and foam
  std::uint32_t particles = 0;
};

/// Returns the counts for a surface with this many samples along each side and at most this many particles.
constexpr ReducedCounts reducedCounts(std::uint32_t surface_resolution_count, std::uint32_t particle_count) {
  ReducedCounts out;
  for (const LevelBudget& budget : kLevelBudgets) {
    out.planes += surface_resolution_count > budget.surface_resolution_count ? 1 : 0;
    out.particles += particle_count > budget.particle_count ? 1 : 0;
  }
  return out;
}

/// Returns the level at which a layer is sent to a client that requests `wanted`: kFull if `wanted` does not downsample
/// the layer. `reduced_count`: number of levels that do.
constexpr Level effectiveLevel(Level wanted, std::uint32_t reduced_count) {
  return indexOf(wanted) < reduced_count ? wanted : Level::kFull;
}

/// Returns whether a layer is packed and encoded at this level: kFull, and the levels that downsample the layer.
constexpr bool isSent(Level level, std::uint32_t reduced_count) {
  return effectiveLevel(level, reduced_count) == level;
}

/// Returns n where the level takes every n-th frame of the room; 1 for a level without a limit of the rate.
constexpr std::uint32_t frameStride(Level level, double frame_rate_hz) {
  const double ratio = frame_rate_hz / budgetOf(level).rate_hz;
  std::uint32_t stride = 1;
  while (stride < ratio - 1e-9) ++stride;
  return stride;
}

}  // namespace spindrift::core
