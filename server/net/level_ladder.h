// Which level of detail a link can carry: found by trying, since nobody can ask it. Plain arithmetic on a time that the
// caller passes in.
#pragma once

#include <cstdint>
#include <optional>

#include <spindrift/core/level.h>

#include "rate_limit.h"

namespace spindrift::net {

/// Steps down when frames go missing, up again when none did for a while; a step up that fails is tried again after
/// twice the time.
class LevelLadder {
 public:
  /// A frame was due for the session; `lost`: one before it still waited, or it built on one that was lost.
  void noteFrame(bool lost) {
    ++due_count_;
    lost_count_ += lost ? 1 : 0;
  }

  /// Judges what was noted, once a kWindow; the new level if it changed. From `reduced_count` on all levels are the
  /// same; with 0 there is nothing to step down to.
  std::optional<core::Level> review(Clock::time_point now, std::uint32_t reduced_count);

  /// At most this.
  core::Level level() const { return level_; }

  static constexpr auto kWindow = std::chrono::seconds(1);
  static constexpr auto kFirstPatience = std::chrono::seconds(4);
  static constexpr auto kLongestPatience = std::chrono::seconds(64);
  /// A step up that has held for so long is not undone by the next one down.
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
