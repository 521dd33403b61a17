// Effects in time: which pulses are active, and what each adds to the surface during one wave step.
#pragma once

#include <vector>

#include <shared/event_uniforms.h>

#include <spindrift/core/command.h>
#include <spindrift/core/result.h>
#include <spindrift/sim/derive.h>

namespace spindrift::sim {

/// 0 before the pulse, 1 after it, smooth between (smoothstep; its derivative is a smooth bump). `phase` = time since
/// the start over the duration.
double pulse(double phase);

/// At most MAX_EVENTS pulses at a time.
class Effects {
 public:
  /// Starts an effect at time_s. kUnavailable when MAX_EVENTS are active: try again when one has ended.
  core::Result<void> start(const core::Effect& effect, double time_s);

  /// What the active effects add during [time_s, time_s + dt_s]; those that have ended are forgotten.
  shared::EventUniforms advance(double time_s, const WaveLayout& wave);

  [[nodiscard]] bool idle() const { return active_.empty(); }
  void clear() { active_.clear(); }

 private:
  struct Active {
    core::Effect effect;
    double start_s = 0.0;
  };
  std::vector<Active> active_;
};

}  // namespace spindrift::sim
