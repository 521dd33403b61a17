// A mark in the stream of commands that tells when the device has done everything before it.
#pragma once

#include <chrono>
#include <cstdint>

#include <spindrift/gpu/context.h>

namespace spindrift::gpu {

enum class FenceState {
  kPending,  ///< the device is not there yet
  kPassed,   ///< everything submitted before the fence is done
  kLost,     ///< the device was lost or the driver refused the fence; it will never be passed
};

/// Move-only; used and destroyed on the context's thread, before the context.
class Fence {
 public:
  /// Puts a fence behind everything submitted so far and hands the work to the device.
  static Fence insert(Context& ctx);
  Fence() = default;  ///< no fence: poll() and wait() answer kPassed
  ~Fence();
  Fence(Fence&& other) noexcept;
  Fence& operator=(Fence&& other) noexcept;

  /// Never waits. An answer other than kPending is final. Fences of a context are passed in the order of insert().
  FenceState poll();
  /// Waits until the fence is passed or the device lost, at most `limit`; kPending when that was not enough. Does not
  /// care whether Context::holdFences() holds this fence.
  FenceState wait(std::chrono::nanoseconds limit);

 private:
  void finish(FenceState state);

  Context* ctx_ = nullptr;
  void* sync_ = nullptr;  ///< GLsync; null once the answer is final
  FenceState state_ = FenceState::kPassed;
  std::uint32_t held_polls_count_ = 0;
};

}  // namespace spindrift::gpu
