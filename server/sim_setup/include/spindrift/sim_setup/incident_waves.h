// What a wave-maker lets in over time: the waves of core::WaveMaker as elevation and flow at its side. Pure functions
// of the scene; docs/wave_makers.md has the equations.
#pragma once

#include <vector>

#include <spindrift/core/result.h>
#include <spindrift/core/scene.h>
#include <spindrift/sim_setup/derive.h>

namespace spindrift::sim {

/// At the side, toward the water inside.
struct Incident {
  double elevation_m = 0.0;  ///< of the cells beside the side while nothing comes back, as a maker sees it
  double flow_m2ps = 0.0;
};

class IncidentWaves {
 public:
  /// amplitude cos(omega t + phase); the flow is in phase with the wave that travels away, the level at the side is
  /// not.
  struct Component {
    double omega_radps, phase_rad, flow_m2ps, edge_m, edge_phase_rad;
  };
  /// Values at times step_s apart, from begin_s on; 0 before and after.
  struct Table {
    double begin_s = 0.0, step_s = 1.0;
    std::vector<Incident> values;
  };

  /// Makes the waves of a wave-maker. Preconditions: makersFit(), and layout.dt_s is set. `depth_m`: at the side.
  static IncidentWaves of(const core::WaveMaker& maker, const core::Scene& scene, const WaveLayout& layout,
                          double depth_m);

  /// Returns the waves at a time; `time_s`: since the start of the scene; the middle of a step.
  [[nodiscard]] Incident at(double time_s) const;
  /// Returns the flow per level that takes up what comes back [m/s].
  [[nodiscard]] double absorbing_mps() const { return absorbing_mps_; }
  [[nodiscard]] double depth_m() const { return depth_m_; }

 private:
  /// Returns what components or table say.
  [[nodiscard]] Incident linearAt(double since_s) const;

  double begin_s_ = 0.0, duration_s_ = 0.0, ramp_s_ = 0.0;
  double depth_m_ = 0.0, gravity_mps2_ = 0.0, absorbing_mps_ = 0.0;
  bool is_simple_wave_ = false;  ///< nonlinear without dispersion: the flow follows from the level
  double seen_later_s_ = 0.0;    ///< of a simple wave: the level inside is that of this much later
  double own_part_spm_ = 0.0;    ///< and lower by this share of the flow
  std::vector<Component> components_;
  Table table_;
};

/// Returns the still depth of the deepest cell along a side; not positive where all of it is dry. [m]
[[nodiscard]] double depthAtSide(const core::Scene& scene, const WaveLayout& layout, core::Side side);

/// Checks what depends on the lengths of the waves: the side has water, the grid resolves the waves, and they are not
/// so high that they break at once. kInvalidInput names the field.
core::Result<void> makersFit(const core::Scene& scene, const WaveLayout& layout);

}  // namespace spindrift::sim
