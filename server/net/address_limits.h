// Limits per client address, over all its connections.
#pragma once

#include <cstddef>
#include <mutex>
#include <string>
#include <unordered_map>

#include <spindrift/net/server.h>

#include "rate_limit.h"

namespace spindrift::net {

/// Thread-safe. Remembers at most kMaxAddressCount addresses; a new one replaces the one that was idle longest.
class AddressLimits {
 public:
  static constexpr std::size_t kMaxAddressCount = 4096;

  explicit AddressLimits(const ServerOptions& options);

  /// Takes a token for one request of this address; returns false if the bucket is empty.
  bool takeRequest(const std::string& address, Clock::time_point now);
  /// Takes a token for one message of this address; returns the time that the message has to wait.
  Clock::duration reserveMessage(const std::string& address, Clock::time_point now);
  std::size_t addressCount() const;

  /// Number of sessions that one address may have open.
  [[nodiscard]] std::size_t sessionMaxCount() const { return session_max_count_; }
  /// Counts one more session of this address; returns false at the limit. After true, call releaseSession() at its end.
  bool takeSession(const std::string& address);
  void releaseSession(const std::string& address);

 private:
  struct Account {
    TokenBucket requests;
    TokenBucket messages;
    Clock::time_point used;
  };
  Account& account(const std::string& address, Clock::time_point now);

  const ServerOptions options_;
  const std::size_t session_max_count_;
  mutable std::mutex mutex_;
  std::unordered_map<std::string, Account> accounts_;
  std::unordered_map<std::string, std::size_t> session_counts_;  ///< open ones; bounded by max_session_count
};

}  // namespace spindrift::net
