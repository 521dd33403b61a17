// A mark in the stream of commands that tells when the device has done everything before it.
#pragma once

#include <chrono>
#include <cstdint>

#include <spindrift/gpu/context.h>

namespace spindrift::gpu {

/// Tells when everything that was submitted before it is done. Fences of one context are passed in the order in which
/// they were inserted. Move-only; used and destroyed on the context's thread, before the context.
class Fence {
 public:
  enum class Status {
    kPassed,
    kPending,  ///< not passed within the time given
    kFailed,   ///< it will never be passed: the device was lost (Context::isLost()), or the driver refuses to wait
  };

  /// Puts a fence behind all work submitted so far and hands that work to the device. Does not wait.
  static Fence insert(Context& ctx);
  Fence() = default;  ///< holds nothing: kPassed
  ~Fence();
  Fence(Fence&& other) noexcept;
  Fence& operator=(Fence&& other) noexcept;

  /// Waits until the fence is passed or the device lost, at most `timeout`. Zero asks without waiting. An answer other
  /// than kPending is final.
  [[nodiscard]] Status wait(std::chrono::nanoseconds timeout);
  [[nodiscard]] Status poll() { return wait(std::chrono::nanoseconds(0)); }

 private:
  void finish(Status status);

  Context* ctx_ = nullptr;
  void* sync_ = nullptr;  ///< GLsync; null once the answer is final
  Status status_ = Status::kPassed;
  std::uint64_t number_ = 0;  ///< in the order of insertion
};

}  // namespace spindrift::gpu
