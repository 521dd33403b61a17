// Finds the level of detail that a link can carry by trying, because a link has no query for it. The caller passes the
// time in; no clock is read.
#pragma once

#include <cstdint>
#include <optional>

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

  /// Evaluates the counts once per kWindow; returns the new level if it changed. `reduced_count`: number of levels that
  /// downsample the layer; with 0 there is no lower level.
  std::optional<core::Level> review(Clock::time_point now, std::uint32_t reduced_count);

  /// Highest level allowed now.
  core::Level level() const { return level_; }

  static constexpr auto kWindow = std::chrono::seconds(1);
  static constexpr auto kFirstPatience = std::chrono::seconds(4);
  static constexpr auto kLongestPatience = std::chrono::seconds(64);
  /// A step up that lasted this long counts as successful.
  static constexpr auto kProbation = std::chrono::seconds(10);

 private:
  bool stepDown(Clock::time_point now, std::uint32_t reduced_count);
  bool stepUp(Clock::time_point now, std::uint32_t reduced_count);

  core::Level level_ = core::Level::kFull;
  std::uint32_t due_count_ = 0;
  std::uint32_t lost_count_ = 0;
  std::optional<Clock::time_point> window_begin_;
  Clock::time_point clean_since_{};
  std::optional<Clock::time_point> raised_;
  Clock::duration patience_ = kFirstPatience;
};

}  // namespace spindrift::net
