// Finds the level of detail that a link can carry by trying, because a link has no query for it. The caller passes the
// time in; no clock is read.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>

#include <spindrift/core/level.h>

#include "rate_limit.h"

namespace spindrift::net {

/// Steps down when frames are lost, and up again after a while without loss. After a failed step up it waits twice as
/// long before the next try.
class LevelLadder {
 public:
  /// Counts a frame that was due for the session. `lost`: an earlier frame still waited, or it built on a lost frame.
  void noteFrame(bool lost) {
    ++due_count_;
    lost_count_ += lost ? 1 : 0;
  }

  /// Returns whether review() has something to do.
  [[nodiscard]] bool isDue(Clock::time_point now) const { return !window_begin_ || now - *window_begin_ >= kWindow; }

  /// Evaluates the counts once per kWindow; returns the new level if it changed. `reduced_count`: number of levels that
  /// downsample the layer; with 0 there is no lower level.
  std::optional<core::Level> review(Clock::time_point now, std::uint32_t reduced_count) {
    if (!window_begin_) {
      window_begin_ = clean_since_ = now;
      return std::nullopt;
    }
    if (!isDue(now)) return std::nullopt;
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

  /// Highest level allowed now.
  core::Level level() const { return level_; }

  static constexpr auto kWindow = std::chrono::seconds(1);
  static constexpr auto kFirstPatience = std::chrono::seconds(4);
  static constexpr auto kLongestPatience = std::chrono::seconds(64);
  /// A step up that lasted this long counts as successful.
  static constexpr auto kProbation = std::chrono::seconds(10);

 private:
  /// A window with fewer frames is not evaluated.
  static constexpr std::uint32_t kLeastDueCount = 4;
  /// Loss of one frame in this many: the link cannot carry the level.
  static constexpr std::uint32_t kTooManyLost = 5;
  /// Loss of one frame in this many: no step up for now.
  static constexpr std::uint32_t kSomeLost = 25;

  bool stepDown(Clock::time_point now, std::uint32_t reduced_count) {
    clean_since_ = now;
    if (raised_ && now - *raised_ < kProbation) patience_ = std::min<Clock::duration>(2 * patience_, kLongestPatience);
    raised_.reset();
    const std::size_t lowest_same = std::min<std::size_t>(indexOf(level_), reduced_count);
    if (lowest_same == 0) return false;
    level_ = static_cast<core::Level>(lowest_same - 1);
    return true;
  }

  bool stepUp(Clock::time_point now, std::uint32_t reduced_count) {
    if (level_ == core::Level::kFull) return false;
    level_ = core::effectiveLevel(static_cast<core::Level>(indexOf(level_) + 1), reduced_count);
    clean_since_ = now;
    raised_ = now;
    return true;
  }

  core::Level level_ = core::Level::kFull;
  std::uint32_t due_count_ = 0;
  std::uint32_t lost_count_ = 0;
  std::optional<Clock::time_point> window_begin_;
  Clock::time_point clean_since_{};
  std::optional<Clock::time_point> raised_;
  Clock::duration patience_ = kFirstPatience;
};

}  // namespace spindrift::net
