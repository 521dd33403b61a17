// Limits the rate of frames. The caller passes the time in; no clock is read.
#pragma once

#include <algorithm>
#include <chrono>

#include <spindrift/core/token_bucket.h>

namespace spindrift::net {

using Clock = std::chrono::steady_clock;
using core::TokenBucket;

/// Lets frames through at `max_rate_hz` on average. The rate has 10 % tolerance, and a frame may come 40 % of an
/// interval early: a 30 Hz stream with jitter passes a 30 Hz watch without loss, while a 60 Hz stream is halved evenly
/// (a frame at half the interval is too early).
class RateGate {
 public:
  RateGate() = default;
  explicit RateGate(double max_rate_hz) : interval_s_(1.0 / (kRateTolerance * max_rate_hz)) {}

  /// Returns the time from which on pass() lets a frame through; in the past if it does now.
  Clock::time_point opens() const {
    return started_ ? due_ - seconds(kEarlyRatio * interval_s_) : Clock::time_point::min();
  }
  bool isOpen(Clock::time_point now) const { return now >= opens(); }

  bool pass(Clock::time_point now) {
    if (!isOpen(now)) return false;
    due_ = (started_ ? std::max(due_, now) : now) + seconds(interval_s_);
    started_ = true;
    return true;
  }

 private:
  static Clock::duration seconds(double s) {
    return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(s));
  }

  static constexpr double kRateTolerance = 1.1;
  static constexpr double kEarlyRatio = 0.4;

  double interval_s_ = 0.0;
  bool started_ = false;
  Clock::time_point due_{};
};

}  // namespace spindrift::net
