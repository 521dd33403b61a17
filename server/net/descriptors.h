// File descriptors: how many connections the process may hold without taking them from its files and devices.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

namespace spindrift::net {

/// Returns how many connections may be open at a time: `wanted_count`, or as many as RLIMIT_NOFILE leaves after the
/// descriptors that are open now and `reserved_count` more. Raises the soft limit as far as it is needed and the hard
/// limit allows. Fewer than wanted are logged with what to do. At least 1. Call it before connections exist.
std::size_t limitConnections(std::size_t wanted_count, std::size_t reserved_count);

/// Decides when to log something that may happen thousands of times per second: the first time, then with the number of
/// times once per kInterval. Not thread-safe.
class RareLine {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::seconds kInterval{10};

  /// Call it each time. Returns how often it has happened since the last line when a line is due, this time included.
  std::optional<std::uint64_t> count(Clock::time_point now) {
    ++unsaid_count_;
    if (said_ && now < *said_ + kInterval) return std::nullopt;
    said_ = now;
    return std::exchange(unsaid_count_, 0);
  }

 private:
  std::optional<Clock::time_point> said_;
  std::uint64_t unsaid_count_ = 0;
};

}  // namespace spindrift::net
