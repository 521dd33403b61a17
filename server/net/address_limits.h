// How much everybody behind one address may ask for, whatever the number of connections.
#pragma once

#include <cstddef>
#include <mutex>
#include <string>
#include <unordered_map>

#include <spindrift/net/server.h>

#include "rate_limit.h"

namespace spindrift::net {

/// Thread-safe. Remembers at most kMaxAddressCount addresses; the one that was quiet longest is forgotten for a new
/// one.
class AddressLimits {
 public:
  static constexpr std::size_t kMaxAddressCount = 4096;

  explicit AddressLimits(const ServerOptions& options);

  /// Whether one more request of this address may be heard.
  bool takeRequest(const std::string& address, Clock::time_point now);
  /// How long one more message of this address has to wait.
  Clock::duration reserveMessage(const std::string& address, Clock::time_point now);
  std::size_t addressCount() const;

  /// Sessions that one address may hold at a time.
  [[nodiscard]] std::size_t sessionMaxCount() const { return session_max_count_; }
  /// Counts one more session of this address, or says no. Each yes is to be given back with releaseSession().
  bool takeSession(const std::string& address);
  void releaseSession(const std::string& address);

 private:
  struct Account {
    TokenBucket requests;
    TokenBucket messages;
    Clock::time_point used;
  };
  Account& account(const std::string& address, Clock::time_point now);

  const double requests_per_s_;
  const double request_burst_count_;
  const double messages_per_s_;
  const double message_burst_count_;
  const std::size_t session_max_count_;
  mutable std::mutex mutex_;
  std::unordered_map<std::string, Account> accounts_;
  std::unordered_map<std::string, std::size_t> session_counts_;  ///< open ones; bounded by max_session_count
};

}  // namespace spindrift::net
