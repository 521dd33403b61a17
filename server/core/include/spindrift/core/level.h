// Levels of detail, for clients that cannot receive the full data. The client chooses a level, or the server adapts it.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <spindrift/core/cell_counts.h>

namespace spindrift::core {

/// Coarsest first. The values are the indices of all arrays by level. The levels below kFull, called the reduced
/// levels, limit the size and the rate of the frames.
enum class Level : std::uint8_t { kCoarse, kMedium, kFine, kFull };
inline constexpr std::array kLevels = {Level::kCoarse, Level::kMedium, Level::kFine, Level::kFull};
inline constexpr std::size_t kLevelCount = kLevels.size();

constexpr std::size_t indexOf(Level level) {
  return static_cast<std::size_t>(level);
}

/// A set of levels.
class LevelSet {
 public:
  constexpr LevelSet() = default;
  [[nodiscard]] static constexpr LevelSet all() { return LevelSet((1U << kLevelCount) - 1U); }

  constexpr void insert(Level level) { bits_ |= 1U << indexOf(level); }
  constexpr void erase(Level level) { bits_ &= ~(1U << indexOf(level)); }
  [[nodiscard]] constexpr bool contains(Level level) const { return (bits_ >> indexOf(level) & 1U) != 0; }
  /// Returns a bit per level: bit indexOf(level).
  [[nodiscard]] constexpr std::uint32_t bits() const { return bits_; }
  [[nodiscard]] static constexpr LevelSet fromBits(std::uint32_t bits) { return LevelSet(bits & all().bits_); }

  friend constexpr bool operator==(const LevelSet&, const LevelSet&) = default;

 private:
  explicit constexpr LevelSet(std::uint32_t bits) : bits_(bits) {}
  std::uint32_t bits_ = 0;
};

/// Limits of one level. The defaults are not a limit.
struct LevelBudget {
  /// Samples of the surface: as many as a square of so many along each side. The foam has half as many along each axis.
  std::uint32_t surface_side_count = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t particle_count = std::numeric_limits<std::uint32_t>::max();
  double rate_hz = std::numeric_limits<double>::infinity();
};
/// Indexed by Level; kFull has no limit.
inline constexpr std::array<LevelBudget, kLevelCount> kLevelBudgets{
    {{128, 8192, 20.0}, {256, 32768, 30.0}, {512, 131072, 30.0}, {}}};

constexpr const LevelBudget& budgetOf(Level level) {
  return kLevelBudgets[indexOf(level)];
}

/// Returns the samples of a surface of this many cells at a level: its cells if they are within the budget, otherwise
/// as many as fit into it in the same proportion.
inline CellCounts surfaceSamples(CellCounts cells, Level level) {
  const double side = budgetOf(level).surface_side_count;
  if (static_cast<double>(cells.total()) <= side * side) return cells;
  const double x = std::floor(side * std::sqrt(static_cast<double>(cells.x) / cells.z));
  const double z = std::floor(x * cells.z / cells.x);
  // Long and narrow water keeps one row or column of samples.
  const double most = std::min(side * side, 1e9);
  if (z < 1) return {static_cast<std::uint32_t>(std::min(most, 1.0 * cells.x)), 1};
  if (x < 1) return {1, static_cast<std::uint32_t>(std::min(most, 1.0 * cells.z))};
  return {static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(z)};
}

/// Returns the samples of a foam field beside surface samples.
constexpr CellCounts foamSamples(CellCounts surface) {
  return {(surface.x + 1) / 2, (surface.z + 1) / 2};
}

/// Number of levels that downsample a layer. They are the lowest ones; every other level has the data of kFull.
struct ReducedCounts {
  std::uint32_t planes = 0;  ///< surface and foam
  std::uint32_t particles = 0;
  bool operator==(const ReducedCounts&) const = default;
};

/// Returns the counts for a surface of this many cells and at most this many particles.
inline ReducedCounts reducedCounts(CellCounts surface, std::uint32_t particle_count) {
  ReducedCounts out;
  for (const Level level : kLevels) {
    out.planes += surfaceSamples(surface, level) != surface ? 1 : 0;
    out.particles += particle_count > budgetOf(level).particle_count ? 1 : 0;
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

/// Returns whether the rate of a level includes a frame that comes so long after the last one that the level took: the
/// frames of a level keep their distance, and a room that makes fewer of them gives it all. Times may be rounded.
constexpr bool takesFrameAfter(Level level, double since_last_s) {
  constexpr double kTolerance = 0.05;
  return since_last_s * budgetOf(level).rate_hz >= 1.0 - kTolerance;
}

/// Data of a frame of one layer, and levels whose sessions take it.
struct FrameLevels {
  Level level = Level::kFull;       ///< of its data
  std::uint32_t reduced_count = 0;  ///< number of levels that downsample the layer; others equal kFull
  LevelSet due = LevelSet::all();   ///< levels whose rate includes the frame: see takesFrameAfter()

  /// Returns whether the frame has the data of the level `wanted`.
  [[nodiscard]] constexpr bool isOf(Level wanted) const { return effectiveLevel(wanted, reduced_count) == level; }
};

}  // namespace spindrift::core
