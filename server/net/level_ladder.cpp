#include "level_ladder.h"

#include <algorithm>
#include <utility>

namespace spindrift::net {
namespace {

/// A window with fewer frames is not evaluated.
constexpr std::uint32_t kLeastDueCount = 4;
/// Loss of one frame in this many: the link cannot carry the level.
constexpr std::uint32_t kTooManyLost = 5;
/// Loss of one frame in this many: no step up for now.
constexpr std::uint32_t kSomeLost = 25;

core::Level levelAt(std::size_t index) {
  return static_cast<core::Level>(index);
}

}  // namespace

std::optional<core::Level> LevelLadder::review(Clock::time_point now, std::uint32_t reduced_count) {
  if (!window_begin_) {
    window_begin_ = clean_since_ = now;
    return std::nullopt;
  }
  if (now - *window_begin_ < kWindow) return std::nullopt;
  window_begin_ = now;
  const std::uint32_t due_count = std::exchange(due_count_, 0);
  const std::uint32_t lost_count = std::exchange(lost_count_, 0);
  bool changed = false;
  if (due_count >= kLeastDueCount && lost_count * kTooManyLost > due_count) {
    changed = stepDown(now, reduced_count);
  } else if (lost_count * kSomeLost > due_count) {
    clean_since_ = now;
  } else if (now - clean_since_ >= patience_) {
    changed = stepUp(now, reduced_count);
  }
  if (raised_ && now - *raised_ >= kLongestPatience) patience_ = kFirstPatience;
  return changed ? std::optional(level_) : std::nullopt;
}

bool LevelLadder::stepDown(Clock::time_point now, std::uint32_t reduced_count) {
  clean_since_ = now;
  if (raised_ && now - *raised_ < kProbation) patience_ = std::min<Clock::duration>(2 * patience_, kLongestPatience);
  raised_.reset();
  const std::size_t lowest_same = std::min<std::size_t>(indexOf(level_), reduced_count);
  if (lowest_same == 0) return false;
  level_ = levelAt(lowest_same - 1);
  return true;
}

bool LevelLadder::stepUp(Clock::time_point now, std::uint32_t reduced_count) {
  if (level_ == core::Level::kFull) return false;
  level_ = core::effectiveLevel(levelAt(indexOf(level_) + 1), reduced_count);
  clean_since_ = now;
  raised_ = now;
  return true;
}

}  // namespace spindrift::net
