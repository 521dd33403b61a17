// Bounds how far the host may run ahead of the device.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>

#include <spindrift/core/result.h>
#include <spindrift/gpu/context.h>
#include <spindrift/gpu/fence.h>

namespace spindrift::sim {

/// One fence per submitted tick. Without a bound, a device that is slower than real time would collect ticks without
/// limit: frames would grow older, health would arrive too late to act on, and the duration of a step on the host would
/// not show how slow the device is.
class TicksInFlight {
 public:
  /// Largest number of submitted, unfinished ticks. Two keep a device busy while the host prepares the next; the third
  /// covers a delay of the host.
  static constexpr std::size_t kMaxCount = 3;
  /// A tick that takes longer than this counts as a hang. Drivers reset a device after 2 to 10 s.
  static constexpr std::chrono::seconds kPatience{10};

  explicit TicksInFlight(gpu::Context& ctx) : ctx_(ctx) {}

  /// Waits until fewer than kMaxCount ticks are in flight. kInternal when the oldest tick has not finished after
  /// kPatience, or when the driver reports an error; the message names the tick.
  core::Result<void> waitForRoom();
  /// Call it after all work of the tick has been submitted.
  void submitted(std::uint64_t tick);
  [[nodiscard]] std::size_t count() const { return ticks_.size(); }

 private:
  struct Tick {
    std::uint64_t number;
    gpu::Fence fence;
  };

  gpu::Context& ctx_;
  std::deque<Tick> ticks_;  ///< oldest first, at most kMaxCount
};

}  // namespace spindrift::sim
