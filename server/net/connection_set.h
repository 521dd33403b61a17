// All open TCP connections, so that a shutdown can reach them and wait for their end.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <unordered_map>
#include <vector>

namespace spindrift::net {

/// The interface of a connection for the shutdown. Thread-safe; both calls return at once.
class Stoppable {
 public:
  virtual ~Stoppable() = default;
  /// A session closes with 1001; a plain HTTP connection is just closed.
  virtual void shutDown() = 0;
  /// Closes the socket now.
  virtual void cut() = 0;
};

/// Thread-safe.
class ConnectionSet {
 public:
  explicit ConnectionSet(std::size_t max_count) : max_count_(max_count) {}

  /// Adds the connection; returns false when the set is full or closed.
  bool add(std::uint64_t id, std::shared_ptr<Stoppable> connection);
  void remove(std::uint64_t id);
  std::size_t count() const;
  std::size_t maxCount() const { return max_count_; }

  /// Refuses new connections from now on.
  void close();
  /// Returns the connections open now.
  std::vector<std::shared_ptr<Stoppable>> all() const;
  /// Returns true when the last connection is gone, false if that does not happen by `deadline`.
  bool waitEmpty(std::chrono::steady_clock::time_point deadline);

 private:
  const std::size_t max_count_;
  mutable std::mutex mutex_;
  std::condition_variable emptied_;
  bool closed_ = false;
  std::unordered_map<std::uint64_t, std::shared_ptr<Stoppable>> connections_;
};

}  // namespace spindrift::net
