// Limit of commands per person, over all sessions, requests and rooms.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>

#include <spindrift/core/token_bucket.h>

namespace spindrift::access {

/// Thread-safe. Remembers at most kMaxPersonCount people; a new one replaces the one that was idle longest.
class PersonLimits {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;
  static constexpr std::size_t kMaxPersonCount = 4096;

  PersonLimits(double commands_per_s, double burst_count)
      : commands_per_s_(commands_per_s), burst_count_(burst_count) {}

  /// Takes one command of this person; returns false, and counts it, if the bucket is empty.
  bool take(const std::string& subject, TimePoint now);

  [[nodiscard]] std::size_t personCount() const;
  /// Commands refused since the start.
  [[nodiscard]] std::uint64_t refusedCount() const { return refused_count_; }
  [[nodiscard]] double commandsPerSecond() const { return commands_per_s_; }
  [[nodiscard]] double burstCount() const { return burst_count_; }

 private:
  struct Account {
    core::TokenBucket commands;
    TimePoint used;
  };

  const double commands_per_s_;
  const double burst_count_;
  std::atomic<std::uint64_t> refused_count_{0};
  mutable std::mutex mutex_;
  std::map<std::string, Account> accounts_;
};

}  // namespace spindrift::access
