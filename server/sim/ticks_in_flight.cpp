#include "ticks_in_flight.h"

#include <cassert>

#include <fmt/format.h>

namespace spindrift::sim {

core::Result<void> TicksInFlight::waitForRoom() {
  while (ticks_.size() >= kMaxCount) {
    switch (ticks_.front().fence.wait(kPatience)) {
      case gpu::Fence::Status::kPassed:
        ticks_.pop_front();
        break;
      case gpu::Fence::Status::kPending:
        return core::Error{core::ErrorCode::kInternal,
                           fmt::format("the device has not finished tick {} after {} s: it hangs, or the scene is far "
                                       "beyond it; start the room again, with fewer particles or a coarser wave",
                                       ticks_.front().number, kPatience.count())};
      case gpu::Fence::Status::kFailed:
        return core::Error{core::ErrorCode::kInternal,
                           fmt::format("the driver cannot tell whether tick {} is done: the device was lost; start the "
                                       "room again on a new context",
                                       ticks_.front().number)};
    }
  }
  return {};
}

void TicksInFlight::submitted(std::uint64_t tick) {
  assert(ticks_.size() < kMaxCount);
  ticks_.push_back({tick, gpu::Fence::insert(ctx_)});
}

}  // namespace spindrift::sim
