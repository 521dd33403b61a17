// Copies of the state on the device, for recovery. A copy counts as good once the health of its tick is known to be
// good.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <spindrift/core/result.h>
#include <spindrift/gpu/buffer.h>

namespace spindrift::sim {

/// Two copies of each state buffer: the last one confirmed good, and one that waits for its health.
class Checkpoints {
 public:
  /// `state` are the live buffers; the pointers must stay valid.
  static core::Result<std::unique_ptr<Checkpoints>> create(gpu::Context& ctx, std::vector<gpu::Buffer*> state);

  /// Copies the state of this tick, without waiting. Does nothing while an earlier copy still waits for its health: if
  /// each copy replaced the one before, a device that is far behind would never get a good one.
  void save(std::uint64_t tick);
  /// Reports that the state at `tick` was good: confirms the copies made up to it.
  void confirm(std::uint64_t tick);
  /// Restores the last good copy; returns false when there is none.
  bool restore();
  void forget();

 private:
  struct Copy {
    std::vector<gpu::Buffer> buffers;
    std::uint64_t tick = 0;
    bool is_filled = false;
  };

  Checkpoints() = default;

  std::vector<gpu::Buffer*> state_;
  Copy copies_[2];
  int good_ = 0;  ///< the other copy waits for its health
  bool has_good_ = false;
};

}  // namespace spindrift::sim
