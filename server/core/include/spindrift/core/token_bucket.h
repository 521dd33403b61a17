// Rate limit; the caller passes the time in, no clock is read.
#pragma once

#include <algorithm>
#include <chrono>

namespace spindrift::core {

/// `rate_per_s` tokens are added per second up to `burst_count`; each message takes one.
class TokenBucket {
 public:
  TokenBucket(double rate_per_s, double burst_count, std::chrono::steady_clock::time_point now)
      : rate_per_s_(rate_per_s), burst_count_(burst_count), tokens_(burst_count), updated_(now) {}

  bool take(std::chrono::steady_clock::time_point now) {
    refill(now);
    if (tokens_ < 1.0) return false;
    tokens_ -= 1.0;
    return true;
  }

  /// Takes a token, in advance if none is left. Returns the time until that token is due.
  std::chrono::steady_clock::duration reserve(std::chrono::steady_clock::time_point now) {
    refill(now);
    tokens_ -= 1.0;
    if (tokens_ >= 0.0) return {};
    return std::chrono::duration_cast<std::chrono::steady_clock::duration>(
        std::chrono::duration<double>(-tokens_ / rate_per_s_));
  }

 private:
  void refill(std::chrono::steady_clock::time_point now) {
    const double elapsed_s = std::chrono::duration<double>(now - updated_).count();
    updated_ = now;
    tokens_ = std::min(burst_count_, tokens_ + rate_per_s_ * elapsed_s);
  }

  double rate_per_s_;
  double burst_count_;
  double tokens_;
  std::chrono::steady_clock::time_point updated_;
};

}  // namespace spindrift::core
