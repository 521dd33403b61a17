// A crowd of clients on one server: how many frames each receives, the delay of frames, and the delay of answers.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <spindrift/core/bytes.h>
#include <spindrift/net/client.h>

namespace spindrift::bench {

/// Kind of a received message.
struct Sighting {
  enum class Kind { kOther, kFrame, kAnswer };
  Kind kind = Kind::kOther;
  std::uint64_t number = 0;                           ///< of the answered command
  std::chrono::steady_clock::time_point published{};  ///< of a frame that contains it; otherwise the epoch
};

struct CrowdOptions {
  std::size_t client_count = 100;
  std::string ca_file;                        ///< of ClientPool, for wss://
  std::size_t deaf_count = 0;                 ///< this many of them never read
  double visitors_per_s = 0.0;                ///< additional clients that connect, watch for a second, and leave
  double commands_per_s = 0.0;                ///< of each client that reads
  std::chrono::duration<double> settle{1.0};  ///< time until all clients are connected; not measured
  std::chrono::duration<double> duration{5.0};
  std::vector<core::SharedBytes> on_open;  ///< first messages of every client
  std::function<core::SharedBytes(std::uint64_t number)>
      command;  ///< returns a command with this number; each client has its own numbers
  std::function<Sighting(core::ByteView)> look;
};

struct CrowdReport {
  std::size_t connected_count = 0;  ///< clients that got a Welcome
  std::size_t lost_count = 0;       ///< clients that read but lost their connection
  std::uint64_t fewest_frames = 0;  ///< smallest number for a client that reads
  std::uint64_t median_frames = 0;
  std::uint64_t most_frames = 0;
  std::uint64_t received_bytes = 0;
  std::vector<double> delays_ms;  ///< of frames, from publication to receipt, sorted
  /// Delay until the last client that reads had the frame; only frames that all of them received. Sorted.
  std::vector<double> last_delays_ms;
  std::vector<double> answers_ms;      ///< of commands, from sending to the answer, sorted
  std::uint64_t unanswered_count = 0;  ///< commands without an answer at the end, except those of the last half second
};

/// Returns a quantile of sorted values; 0 for no values.
double quantileOf(const std::vector<double>& sorted, double ratio);

/// Connects the crowd, measures, disconnects. `begin` is called when the measured time begins, `end` when it ends.
CrowdReport runCrowd(const net::ClientUrl& url, const CrowdOptions& options, const std::function<void()>& begin = {},
                     const std::function<void()>& end = {});

}  // namespace spindrift::bench
