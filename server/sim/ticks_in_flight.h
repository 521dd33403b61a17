// How far the host may run ahead of the device.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>

#include <spindrift/core/result.h>
#include <spindrift/gpu/context.h>
#include <spindrift/gpu/fence.h>

namespace spindrift::sim {

/// One fence per submitted tick. Without a bound a device that is slower than real time collects ticks without end:
/// frames grow older and older, health arrives too late to act on, and the time that a step takes on the host says
/// nothing about the device.
class TicksInFlight {
 public:
  /// Ticks that may be submitted and not done. Two keep a device busy while the host prepares the next; the third
  /// covers a host that is late once.
  static constexpr std::size_t kMaxCount = 3;
  /// A tick that takes longer than this is taken for a hang. Drivers reset a device after 2 to 10 s.
  static constexpr std::chrono::seconds kPatience{10};

  explicit TicksInFlight(gpu::Context& ctx) : ctx_(ctx) {}

  /// Waits until fewer than kMaxCount ticks are in flight. Error kInternal when the oldest is not done after kPatience,
  /// or the driver cannot tell; it says which tick.
  core::Result<void> waitForRoom();
  /// The tick has been submitted, all of it.
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
