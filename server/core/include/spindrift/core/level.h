// Levels of detail, for clients that cannot receive the full data. The client chooses a level, or the server adapts it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace spindrift::core {

/// Coarsest first. The reduced levels bound the size of a frame; kFull does not.
enum class Level : std::uint8_t { kCoarse, kMedium, kFine, kFull };
inline constexpr std::size_t kLevelCount = 4;
inline constexpr std::array kLevels = {Level::kCoarse, Level::kMedium, Level::kFine, Level::kFull};
/// Levels below kFull: 0 .. kReducedLevelCount - 1.
inline constexpr std::size_t kReducedLevelCount = 3;

constexpr std::size_t indexOf(Level level) {
  return static_cast<std::size_t>(level);
}

/// Limits of one reduced level: size of a frame and frame rate.
struct LevelBudget {
  std::uint32_t surface_resolution_count = 0;  ///< samples along each side; the foam has half as many
  std::uint32_t particle_count = 0;
  double rate_hz = 0.0;
};
inline constexpr std::array<LevelBudget, kReducedLevelCount> kLevelBudgets{
    {{128, 8192, 20.0}, {256, 32768, 30.0}, {512, 131072, 30.0}}};

/// Number of levels that downsample a layer; all levels from this number on equal kFull.
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

/// Returns the level that a layer is sent at when `wanted` is asked for: kFull where `wanted` would leave nothing out.
constexpr Level effectiveLevel(Level wanted, std::uint32_t reduced_count) {
  return indexOf(wanted) < reduced_count ? wanted : Level::kFull;
}

/// Returns n where the level takes every n-th frame of the room; 1 for kFull.
constexpr std::uint32_t frameStride(Level level, double frame_rate_hz) {
  if (level == Level::kFull) return 1;
  const double ratio = frame_rate_hz / kLevelBudgets[indexOf(level)].rate_hz;
  std::uint32_t stride = 1;
  while (stride < ratio - 1e-9) ++stride;
  return stride;
}

}  // namespace spindrift::core
