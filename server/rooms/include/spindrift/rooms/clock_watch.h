// Notices that somebody set the clock of the system.
#pragma once

#include <chrono>
#include <optional>

namespace spindrift::rooms {

/// Compares the clock of the system with one that nobody sets. Both run at nearly the same rate: corrections by NTP are
/// below 0.05 %, so only a step makes them differ by seconds between two calls.
class ClockWatch {
 public:
  using Seconds = std::chrono::duration<double>;

  /// Returns by how much the system's clock was set since the last call, positive for forward; nothing if it was not.
  /// Steps below kLeast are not reported.
  std::optional<Seconds> step(std::chrono::system_clock::time_point wall,
                              std::chrono::steady_clock::time_point steady) {
    const Seconds offset = Seconds(wall.time_since_epoch()) - Seconds(steady.time_since_epoch());
    const Seconds step = offset - offset_.value_or(offset);
    offset_ = offset;
    if (std::chrono::abs(step) < kLeast) return std::nullopt;
    return step;
  }

 private:
  static constexpr Seconds kLeast{2.0};
  std::optional<Seconds> offset_;
};

}  // namespace spindrift::rooms
