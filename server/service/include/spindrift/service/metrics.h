// The program's counters and the /metrics page in Prometheus' text format.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <string>
#include <string_view>

#include <spindrift/net/server.h>
#include <spindrift/rooms/encoder_thread.h>
#include <spindrift/rooms/room_host.h>
#include <spindrift/service/access_control.h>
#include <spindrift/v1/wire.pb.h>

namespace spindrift::service {

/// Counts the answers to commands since the start, of sessions and requests. Thread-safe.
class CommandCounters {
 public:
  void applied() { ++applied_count_; }
  void rejected(v1::RejectReason reason) { ++rejected_count_[static_cast<std::size_t>(reason)]; }
  [[nodiscard]] std::uint64_t appliedCount() const { return applied_count_; }
  [[nodiscard]] std::uint64_t rejectedCount(v1::RejectReason reason) const {
    return rejected_count_[static_cast<std::size_t>(reason)];
  }

 private:
  std::atomic<std::uint64_t> applied_count_{0};
  std::array<std::atomic<std::uint64_t>, v1::RejectReason_ARRAYSIZE> rejected_count_{};
};

/// Parts of the server that start after the gateway; null before.
struct MetricsSources {
  std::atomic<const net::Server*> network{nullptr};
  std::atomic<const rooms::EncoderThread*> encoder{nullptr};
};

/// Returns NAME="VALUE" for any bytes as value: quotes, backslashes and line breaks are escaped as the format of
/// Prometheus says, and what is not UTF-8 is replaced by U+FFFD.
std::string metricLabel(std::string_view name, std::string_view value);

/// "out_of_range", as the page names REJECT_REASON_OUT_OF_RANGE.
std::string nameOf(v1::RejectReason reason);

/// Returns the page of a process without rooms: its network and the answers to commands that it passed on.
std::string metricsText(const net::ServerStats& network, const CommandCounters& commands);

/// Returns one line of a metric without labels, with its head; `type`: "counter" or "gauge".
std::string metric(const char* name, const char* type, const char* help, double value);

/// Returns the whole page. Times in seconds, sizes in bytes; names of counters end in _total.
std::string metricsText(const rooms::RoomHost& rooms, const CommandCounters& commands, const AccessControl& access,
                        const MetricsSources& sources);

}  // namespace spindrift::service
