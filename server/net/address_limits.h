// Limits per client address, over all its connections.
#pragma once

#include <algorithm>
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

  explicit AddressLimits(const ServerOptions& options)
      : options_(options),
        session_max_count_(std::max<std::size_t>(
            1,
            static_cast<std::size_t>(options.address_session_share * static_cast<double>(options.max_session_count)))) {
  }

  /// Takes a token for one request of this address; returns false if the bucket is empty.
  bool takeRequest(const std::string& address, Clock::time_point now) {
    const std::lock_guard lock(mutex_);
    return account(address, now).requests.take(now);
  }
  /// Takes a token for one message of this address; returns the time that the message has to wait.
  Clock::duration reserveMessage(const std::string& address, Clock::time_point now) {
    const std::lock_guard lock(mutex_);
    return account(address, now).messages.reserve(now);
  }
  std::size_t addressCount() const {
    const std::lock_guard lock(mutex_);
    return accounts_.size();
  }

  /// Number of sessions that one address may have open.
  [[nodiscard]] std::size_t sessionMaxCount() const { return session_max_count_; }
  /// Counts one more session of this address; returns false at the limit. After true, call releaseSession() at its end.
  bool takeSession(const std::string& address) {
    const std::lock_guard lock(mutex_);
    std::size_t& count = session_counts_[address];
    if (count >= session_max_count_) return false;
    ++count;
    return true;
  }
  void releaseSession(const std::string& address) {
    const std::lock_guard lock(mutex_);
    const auto found = session_counts_.find(address);
    if (found != session_counts_.end() && --found->second == 0) session_counts_.erase(found);
  }

 private:
  struct Account {
    TokenBucket requests;
    TokenBucket messages;
    Clock::time_point used;
  };

  Account& account(const std::string& address, Clock::time_point now) {
    auto found = accounts_.find(address);
    if (found == accounts_.end()) {
      if (accounts_.size() >= kMaxAddressCount) {
        accounts_.erase(std::ranges::min_element(accounts_, {}, [](const auto& entry) { return entry.second.used; }));
      }
      const TokenBucket requests(options_.address_requests_per_s, options_.address_request_burst_count, now);
      const TokenBucket messages(options_.address_messages_per_s, options_.address_message_burst_count, now);
      found = accounts_.emplace(address, Account{requests, messages, now}).first;
    }
    found->second.used = now;
    return found->second;
  }

  const ServerOptions options_;
  const std::size_t session_max_count_;
  mutable std::mutex mutex_;
  std::unordered_map<std::string, Account> accounts_;
  std::unordered_map<std::string, std::size_t> session_counts_;  ///< open ones; bounded by max_session_count
};

}  // namespace spindrift::net
