// State shared by all connections of one server; it outlives them.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>

#include <spindrift/http/network_text.h>
#include <spindrift/http/static_files.h>
#include <spindrift/http/trusted_networks.h>
#include <spindrift/net/server.h>

#include "address_limits.h"
#include "connection_set.h"
#include "tls_credentials.h"

namespace spindrift::net {

/// The counters among the ServerStats. Thread-safe.
class Counters {
 public:
  void add(std::uint64_t ServerStats::*counter, std::int64_t count = 1) {
    const std::lock_guard lock(mutex_);
    stats_.*counter += static_cast<std::uint64_t>(count);
  }
  void wrote(std::uint64_t bytes_count, std::uint64_t frame_count, bool is_at_once) {
    const std::lock_guard lock(mutex_);
    stats_.sent_bytes_count += bytes_count;
    stats_.sent_frame_count += frame_count;
    ++stats_.write_count;
    stats_.waiting_write_count += is_at_once ? 0 : 1;
  }
  void refused(Refused why) {
    const std::lock_guard lock(mutex_);
    ++stats_.refused_count[static_cast<std::size_t>(why)];
  }
  void closed(std::uint16_t code) {
    // Peers choose their codes: unregistered codes are counted together.
    const bool is_known = code == 0 || (code >= 1000 && code < 1016) || (code >= 4400 && code < 4410);
    const std::lock_guard lock(mutex_);
    ++stats_.closed_by_code[is_known ? code : std::uint16_t{4000}];
  }
  ServerStats stats() const {
    const std::lock_guard lock(mutex_);
    return stats_;
  }

 private:
  mutable std::mutex mutex_;
  ServerStats stats_;
};

/// TCP connections beyond the sessions, for page loads, probes and unknown peers. Further ones are closed without a
/// reply.
inline constexpr std::size_t kSpareConnectionCount = 512;

struct ServerContext {
  const ServerOptions options;
  const TrustedNetworks proxies;
  const std::unique_ptr<TlsCredentials> credentials;  ///< null: the port speaks plain HTTP
  Application& application;
  Hub hub{};
  StaticFiles files{options.web_root};
  ConnectionSet connections{
      limitConnections(options.max_session_count + kSpareConnectionCount, options.reserved_descriptor_count)};
  AddressLimits addresses{options};
  const bool listens_on_loopback = isLoopback(options.address);
  Counters counters{};
  std::atomic<std::int64_t> retry_after_s{0};  ///< > 0: draining, see Server::drain()
  std::atomic<std::uint64_t> last_session_id{0};
  /// Sessions open or in their handshake; at most max_session_count.
  std::atomic<std::size_t> reserved_session_count{0};
  std::atomic<std::size_t> foxglove_session_count{0};  ///< among them
};

}  // namespace spindrift::net
