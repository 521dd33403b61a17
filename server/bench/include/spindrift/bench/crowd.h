// A crowd of clients on one server: how many frames each receives, the delay of frames, and the delay of answers.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include <spindrift/core/bytes.h>
#include <spindrift/net/client.h>

namespace spindrift::bench {

/// Kind of a received message.
struct Sighting {
  enum class Kind { kOther, kFrame, kAnswer };
  Kind kind = Kind::kOther;
  std::uint64_t number = 0;                           ///< of the answered command
  std::chrono::steady_clock::time_point published{};  ///< of a frame that tells; else the epoch
};

struct CrowdOptions {
  std::size_t client_count = 100;
  std::size_t deaf_count = 0;                 ///< of them never read
  double visitors_per_s = 0.0;                ///< come, watch for a second, and go, besides
  double commands_per_s = 0.0;                ///< of every client that reads
  std::chrono::duration<double> settle{1.0};  ///< until all clients are connected; not measured
  std::chrono::duration<double> duration{5.0};
  std::vector<core::SharedBytes> on_open;  ///< what every client says first
  std::function<core::SharedBytes(std::uint64_t number)>
      command;  ///< a command of that number; numbers are a client's own
  std::function<Sighting(core::ByteView)> look;
};

struct CrowdReport {
  std::size_t connected_count = 0;  ///< clients that were welcome
  std::size_t lost_count = 0;       ///< clients that read and whose connection ended nevertheless
  std::uint64_t fewest_frames = 0;  ///< of a client that reads
  std::uint64_t median_frames = 0;
  std::uint64_t most_frames = 0;
  std::uint64_t received_bytes = 0;
  std::vector<double> delays_ms;  ///< of frames, from publication to receipt, sorted
  /// Delay until the last client that reads had the frame; only frames that all of them received. Sorted.
  std::vector<double> last_delays_ms;
  std::vector<double> answers_ms;  ///< of commands, from sending to the answer, sorted
  std::uint64_t unanswered_count =
      0;  ///< commands without an answer at the end, those of the last half second left out
};

/// Returns a quantile of sorted values; 0 if there are none.
double quantileOf(const std::vector<double>& sorted, double ratio);

/// Connects the crowd, measures, disconnects. `begin` is called when the measured time begins, `end` when it ends.
CrowdReport runCrowd(const net::ClientUrl& url, const CrowdOptions& options, const std::function<void()>& begin = {},
                     const std::function<void()>& end = {});

}  // namespace spindrift::bench
