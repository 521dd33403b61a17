// All open TCP connections, so that a shutdown can reach them and wait for their end; and how many of them the process
// may hold without taking file descriptors from its files and devices.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

namespace spindrift::net {

class Connection;

/// Thread-safe.
class ConnectionSet {
 public:
  explicit ConnectionSet(std::size_t max_count) : max_count_(max_count) {}

  /// Adds the connection; returns false when the set is full or closed.
  bool add(std::uint64_t id, std::shared_ptr<Connection> connection);
  void remove(std::uint64_t id);
  std::size_t count() const;
  std::size_t maxCount() const { return max_count_; }

  /// Refuses new connections from now on.
  void close();
  std::vector<std::shared_ptr<Connection>> all() const;
  /// Returns true when the last connection is gone, false if that does not happen by `deadline`.
  bool waitEmpty(std::chrono::steady_clock::time_point deadline);

 private:
  const std::size_t max_count_;
  mutable std::mutex mutex_;
  std::condition_variable emptied_;
  bool closed_ = false;
  std::unordered_map<std::uint64_t, std::shared_ptr<Connection>> connections_;
};

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
