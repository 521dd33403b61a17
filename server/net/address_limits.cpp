#include "address_limits.h"

#include <algorithm>

namespace spindrift::net {

AddressLimits::AddressLimits(const ServerOptions& options)
    : options_(options),
      session_max_count_(std::max<std::size_t>(
          1,
          static_cast<std::size_t>(options.address_session_share * static_cast<double>(options.max_session_count)))) {}

bool AddressLimits::takeRequest(const std::string& address, Clock::time_point now) {
  const std::lock_guard lock(mutex_);
  return account(address, now).requests.take(now);
}

Clock::duration AddressLimits::reserveMessage(const std::string& address, Clock::time_point now) {
  const std::lock_guard lock(mutex_);
  return account(address, now).messages.reserve(now);
}

std::size_t AddressLimits::addressCount() const {
  const std::lock_guard lock(mutex_);
  return accounts_.size();
}

bool AddressLimits::takeSession(const std::string& address) {
  const std::lock_guard lock(mutex_);
  std::size_t& count = session_counts_[address];
  if (count >= session_max_count_) return false;
  ++count;
  return true;
}

void AddressLimits::releaseSession(const std::string& address) {
  const std::lock_guard lock(mutex_);
  const auto found = session_counts_.find(address);
  if (found != session_counts_.end() && --found->second == 0) session_counts_.erase(found);
}

AddressLimits::Account& AddressLimits::account(const std::string& address, Clock::time_point now) {
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

}  // namespace spindrift::net
