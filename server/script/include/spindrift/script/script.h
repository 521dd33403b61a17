// Scripts (proto/spindrift/v1/script.proto): read, checked as far as possible before a client connects, and run against
// a server, one step after another.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <spindrift/core/result.h>
#include <spindrift/net/client.h>
#include <spindrift/v1/script.pb.h>

namespace spindrift::script {

inline constexpr int kScriptClientMaxCount = 256;
inline constexpr int kScriptStepMaxCount = 10'000;
/// Longest time in a script.
inline constexpr double kScriptMax_s = 86'400.0;

/// Loads a script. Errors: kUnavailable for a file that cannot be read, kInvalidInput with `FILE:LINE:COLUMN: what` or
/// `FILE: steps[3]: what`. The result has at least one client, and every step names one.
core::Result<v1::Script> loadScript(const std::filesystem::path& file);
core::Result<v1::Script> parseScript(const std::string& text, const std::string& label);

struct StepReport {
  int index = 0;  ///< of the script's steps
  std::string client;
  std::string what;  ///< "command splash", "surface", ...
  std::string note;  ///< the script's own
  bool passed = false;
  std::string detail;  ///< what was seen; for a failure also what was wanted
  double took_s = 0.0;
};

struct ClientReport {
  std::string name;
  std::uint64_t received_bytes = 0;
  std::uint64_t malformed_count = 0;
  struct Layer {
    std::string name;
    std::uint64_t frame_count = 0;
    std::uint64_t state_count = 0;  ///< different states that they showed
    double longest_gap_s = 0.0;
  };
  std::vector<Layer> layers;
  std::size_t answer_count = 0;
  double answer_p50_ms = 0.0;  ///< from sending a command to its answer
  double answer_p99_ms = 0.0;
};

/// Result of a script with hold_clock.
struct HeldReport {
  std::uint64_t seed = 0;                   ///< 0: that of the scene
  std::uint64_t tick_count = 0;             ///< that it has made
  double made_s = 0.0;                      ///< simulated time of these
  std::optional<std::uint64_t> state_hash;  ///< after the last one
  /// Number of times that the watchdog put the water back. When it acts depends on how fast the device answers, so that
  /// the hash of another run may differ.
  std::uint64_t recovered_count = 0;
};

struct ScriptReport {
  std::vector<StepReport> steps;  ///< those that were run
  std::vector<ClientReport> clients;
  int step_count = 0;  ///< those that there are
  std::optional<HeldReport> held;
  [[nodiscard]] bool passed() const;
};

/// Runs a script that comes from loadScript(). If no server answers at the URL, the first step fails. `ca_file`: that
/// of ClientPool.
ScriptReport runScript(const v1::Script& script, const net::ClientUrl& url, const std::string& ca_file = "");

}  // namespace spindrift::script
