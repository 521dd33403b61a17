// Two small meters, both plain arithmetic on a time that the caller passes in: how often a frame may go out, and how
// many messages a client may send.
#pragma once

#include <algorithm>
#include <chrono>

namespace spindrift::net {

using Clock = std::chrono::steady_clock;

/// Lets frames through no faster than `max_rate_hz` on average. The rate is taken 10 % generously and a frame may come
/// 40 % of an interval early, so that a 30 Hz stream with jitter passes a 30 Hz watch whole, while a 60 Hz stream is
/// halved evenly (a frame at half the interval is still too early).
class RateGate {
 public:
  RateGate() = default;
  explicit RateGate(double max_rate_hz) : interval_s_(1.0 / (kRateTolerance * max_rate_hz)) {}

  /// Whether pass() would let a frame through.
  bool isOpen(Clock::time_point now) const { return !started_ || now + seconds(kEarlyRatio * interval_s_) >= due_; }

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

/// `rate_per_s` tokens flow in, at most `burst_count` wait; every message takes one.
class TokenBucket {
 public:
  TokenBucket(double rate_per_s, double burst_count, Clock::time_point now)
      : rate_per_s_(rate_per_s), burst_count_(burst_count), tokens_(burst_count), updated_(now) {}

  bool take(Clock::time_point now) {
    const double elapsed_s = std::chrono::duration<double>(now - updated_).count();
    updated_ = now;
    tokens_ = std::min(burst_count_, tokens_ + rate_per_s_ * elapsed_s);
    if (tokens_ < 1.0) return false;
    tokens_ -= 1.0;
    return true;
  }

  /// Takes a token that may have yet to come; how long until it is there.
  Clock::duration reserve(Clock::time_point now) {
    const double elapsed_s = std::chrono::duration<double>(now - updated_).count();
    updated_ = now;
    tokens_ = std::min(burst_count_, tokens_ + rate_per_s_ * elapsed_s) - 1.0;
    if (tokens_ >= 0.0) return {};
    return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(-tokens_ / rate_per_s_));
  }

 private:
  double rate_per_s_;
  double burst_count_;
  double tokens_;
  Clock::time_point updated_;
};

}  // namespace spindrift::net
