// A mark in the device's queue of work.
#pragma once

#include <chrono>
#include <cstdint>

#include <spindrift/gpu/context.h>

namespace spindrift::gpu {

/// Tells when everything that was submitted before it is done. Fences of one context pass in the order in which they
/// were inserted. Move-only; must not outlive its context; all calls on the context's thread.
class Fence {
 public:
  enum class Status {
    kPassed,
    kPending,  ///< not passed within the time given
    kFailed,   ///< the driver cannot tell, for example because the context was lost
  };

  /// Puts a fence behind all work submitted so far and hands that work to the device. Does not wait.
  static Fence insert(Context& ctx);
  Fence() = default;  ///< holds nothing; only to be assigned to
  ~Fence();
  Fence(Fence&& other) noexcept;
  Fence& operator=(Fence&& other) noexcept;

  explicit operator bool() const { return sync_ != nullptr; }

  /// Waits until the fence passes, at most `timeout`. Zero asks without waiting.
  [[nodiscard]] Status wait(std::chrono::nanoseconds timeout);

 private:
  Context* ctx_ = nullptr;
  void* sync_ = nullptr;
  std::uint64_t number_ = 0;  ///< in the order of insertion
};

}  // namespace spindrift::gpu
