// The state to go back to when a room goes wrong: copies on the device, trusted once the health of their tick was good.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <spindrift/core/result.h>
#include <spindrift/gpu/buffer.h>

namespace spindrift::sim {

/// Two copies of each state buffer: the last one confirmed good, and one waiting for its health.
class Checkpoints {
 public:
  /// `state` are the live buffers; the pointers must stay valid.
  static core::Result<std::unique_ptr<Checkpoints>> create(gpu::Context& ctx, std::vector<gpu::Buffer*> state);

  /// Copies the state of this tick, without waiting. Nothing while an earlier copy still waits for its health:
  /// replacing it each time would leave a device that is far behind without any good copy.
  void save(std::uint64_t tick);
  /// The state at `tick` was good: copies made up to it are.
  void confirm(std::uint64_t tick);
  /// Puts the last good copy back; false when there is none.
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
  int good_ = 0;  ///< the other one waits
  bool has_good_ = false;
};

}  // namespace spindrift::sim
