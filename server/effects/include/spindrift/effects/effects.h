// Effects in time: which pulses are active, and what each adds to the surface during one wave step.
#pragma once

#include <cstddef>
#include <vector>

#include <shared/event_uniforms.h>

#include <spindrift/core/result.h>
#include <spindrift/core/scene.h>
#include <spindrift/effects/strokes.h>
#include <spindrift/sim_setup/derive.h>

namespace spindrift::sim {

/// The water that effects act on: a rectangle centred on the origin.
struct EffectDomain {
  double side_x_m = 0.0;
  double side_z_m = 0.0;
  double cell_m = 0.0;              ///< smallest length that it resolves
  double speed_mps = 0.0;           ///< of long waves, sqrt(g d)
  double dt_s = 0.0;                ///< between two calls of advance()
  double dispersing_depth_m = 0.0;  ///< d if shorter waves are slower, otherwise 0
};
EffectDomain domainOf(const WaveLayout& wave);

/// The active effects: at most MAX_SPLASHES splashes and MAX_CRESTS crests; and the strokes.
class Effects {
 public:
  /// Starts an effect at time_s; a wave must have a side. kUnavailable when the most effects of its kind are active:
  /// try again when one has ended. `spare`: slots that must stay free, so that rain and wind leave some for clients.
  core::Result<void> start(const core::Effect& effect, double time_s, std::size_t spare = 0);

  /// Returns what the active effects add at time_s, after a step of dt_s, and removes those that have ended.
  shared::EventUniforms advance(double time_s, const EffectDomain& domain);

  [[nodiscard]] bool idle() const { return active_.empty() && strokes_.active().empty(); }
  void clear() {
    active_.clear();
    strokes_.clear();
  }

  [[nodiscard]] Strokes& strokes() { return strokes_; }
  [[nodiscard]] const Strokes& strokes() const { return strokes_; }

  struct Active {
    core::Effect effect;
    double start_s = 0.0;
  };
  [[nodiscard]] const std::vector<Active>& active() const { return active_; }
  /// Replaces them all but the strokes. Returns false, with nothing changed, if there are more of a kind than can be
  /// active.
  bool resume(std::vector<Active> active);

 private:
  std::vector<Active> active_;
  Strokes strokes_;
};

}  // namespace spindrift::sim
