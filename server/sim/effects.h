// Effects in time: which pulses are active, and what each adds to the surface during one wave step.
#pragma once

#include <cstddef>
#include <vector>

#include <shared/event_uniforms.h>

#include <spindrift/core/command.h>
#include <spindrift/core/result.h>
#include <spindrift/sim/derive.h>

namespace spindrift::sim {

/// 0 before the pulse, 1 after it, smooth between (smoothstep; its derivative is a smooth bump). `phase` = time since
/// the start over the duration.
double pulse(double phase);

/// The water that effects act on: a rectangle round the origin.
struct EffectStage {
  double side_x_m = 0.0;
  double side_z_m = 0.0;
  double cell_m = 0.0;     ///< what it resolves
  double speed_mps = 0.0;  ///< of its long waves, sqrt(g d)
  double dt_s = 0.0;       ///< between two calls of advance()
};
EffectStage stageOf(const WaveLayout& wave);

/// At most MAX_SPLASHES splashes and MAX_CRESTS crests at a time.
class Effects {
 public:
  /// Starts an effect at time_s. kUnavailable when as many of its kind are active as can be: try again when one has
  /// ended. `spare`: places that must stay free, so that weather does not crowd out people.
  core::Result<void> start(const core::Effect& effect, double time_s, std::size_t spare = 0);

  /// What the active effects add at time_s, after a step of dt_s; those that have ended are forgotten.
  shared::EventUniforms advance(double time_s, const EffectStage& stage);

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
