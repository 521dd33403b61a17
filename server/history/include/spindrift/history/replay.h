// Runs the log of a room again and compares the state hashes that it contains.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include <spindrift/core/result.h>
#include <spindrift/gpu/device.h>
#include <spindrift/history/command_log.h>

namespace spindrift::history {

struct ReplayOutcome {
  std::uint64_t tick_count = 0;     ///< tick of the last record
  std::uint64_t command_count = 0;  ///< commands that changed the water again
  std::uint64_t hash_count = 0;     ///< hashes compared
  /// The first hash that differs; no later one is compared.
  struct Difference {
    std::uint64_t tick = 0;
    std::uint64_t last_equal_tick = 0;  ///< last tick at which the states were equal
    std::uint64_t recorded = 0;
    std::uint64_t found = 0;
  };
  std::optional<Difference> difference;
  std::optional<std::uint64_t> recovered_tick;  ///< tick of a watchdog intervention; later states need not repeat
  /// Device or driver that differs from the log's, which alone may change states.
  std::optional<std::string> device_difference;
  std::optional<std::string> truncation;  ///< reason and place if the log is not complete
};

/// Errors: those of the scene and the device; those of Repetition.
/// `progress` is called from time to time with the tick.
core::Result<ReplayOutcome> replayLog(const gpu::DeviceChoice& device, CommandLogReader& log,
                                      const std::function<void(std::uint64_t)>& progress = {});

}  // namespace spindrift::history
