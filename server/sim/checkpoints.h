// Copies of the state on the device, for recovery. A copy counts as good once the health of its tick is known to be
// good.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "creation.h"

namespace spindrift::sim {

/// Two copies of each state buffer: the last one confirmed good, and one that waits for its health.
class Checkpoints {
 public:
  /// `state` are the live buffers; the pointers must stay valid.
  Checkpoints(Creation& create, std::vector<gpu::Buffer*> state);

  /// Copies the state of this tick, without waiting. Does nothing while an earlier copy still waits for its health: if
  /// each copy replaced the one before, a device that is far behind would never get a good one.
  void save(std::uint64_t tick);
  /// Reports that the state at `tick` was good: confirms the copies made up to it.
  void confirm(std::uint64_t tick);
  /// Restores the last good copy and returns the factor for its flow (see scaleFlow()); nullopt without a good copy. A
  /// copy is restored once: if the water needs another recovery before a later copy is confirmed, this one led to the
  /// fault (parameters may have changed since it was made), and it is dropped.
  std::optional<double> restore();
  /// The flow of the water was multiplied by this ratio, because a parameter changed: copies made before need it, too.
  void scaleFlow(double ratio);
  void forget();

 private:
  struct Copy {
    std::vector<gpu::Buffer> buffers;
    std::uint64_t tick = 0;
    double flow_ratio = 1.0;
    bool is_filled = false;
  };

  std::vector<gpu::Buffer*> state_;
  Copy copies_[2];
  int good_ = 0;  ///< the other copy waits for its health
  bool has_good_ = false;
  bool is_tried_ = false;  ///< the good one was restored
};

}  // namespace spindrift::sim
