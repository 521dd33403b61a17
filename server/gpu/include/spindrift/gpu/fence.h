// A fence in the command stream: reports when the device has finished all commands before it.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>

#include <spindrift/gpu/context.h>

namespace spindrift::gpu {

/// Fences of one context are passed in the order of their insertion. Move-only; used and destroyed on the context's
/// thread, before the context. A default-constructed fence is passed.
class Fence {
 public:
  enum class Status {
    kPassed,
    kPending,  ///< not passed within the time given
    kFailed,   ///< it will never be passed: the device was lost (Context::isLost()), or the driver refuses to wait
  };

  /// Inserts a fence after all commands submitted so far and flushes them to the device. Does not wait.
  static Fence insert(Context& ctx);

  /// Waits until the fence is passed or the device is lost, at most `timeout`; zero returns at once. A result other
  /// than kPending is final.
  [[nodiscard]] Status wait(std::chrono::nanoseconds timeout);
  [[nodiscard]] Status poll() { return wait(std::chrono::nanoseconds(0)); }

 private:
  struct DeleteSync {
    void operator()(void* sync) const;
  };

  Context* ctx_ = nullptr;
  std::unique_ptr<void, DeleteSync> sync_;  ///< GLsync; null once the result is final
  Status status_ = Status::kPassed;
  std::uint64_t number_ = 0;  ///< in the order of insertion
};

}  // namespace spindrift::gpu
