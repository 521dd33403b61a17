// Runs the log of a room again and compares the state hashes in it.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include <spindrift/core/result.h>
#include <spindrift/gpu/device.h>
#include <spindrift/rooms/command_log.h>

namespace spindrift::rooms {

struct ReplayOutcome {
  std::uint64_t tick_count = 0;     ///< the last record's tick
  std::uint64_t command_count = 0;  ///< carried out again
  std::uint64_t hash_count = 0;     ///< compared
  /// The first hash that differs; nothing is compared after it.
  struct Difference {
    std::uint64_t tick = 0;
    std::uint64_t last_equal_tick = 0;  ///< the state was still the same here
    std::uint64_t recorded = 0;
    std::uint64_t found = 0;
  };
  std::optional<Difference> difference;
  std::optional<std::uint64_t> recovered_tick;  ///< the watchdog had stepped in: what follows need not repeat
  /// Another device or driver than the log's: states may differ for that alone.
  std::optional<std::string> device_difference;
  std::optional<std::string> truncation;  ///< the log has no end: where and why
};

/// Errors: the scene's and the device's; kCheckFailed for a command that is not carried out as it was recorded.
/// `progress` is called now and then with the tick.
core::Result<ReplayOutcome> replayLog(const gpu::DeviceChoice& device, CommandLogReader& log,
                                      const std::function<void(std::uint64_t)>& progress = {});

}  // namespace spindrift::rooms
