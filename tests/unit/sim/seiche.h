// The lowest mode of a walled basin: water whose motion is known.
#pragma once

#include <cmath>
#include <numbers>

#include "sim_fixture.h"

namespace spindrift::sim {

inline constexpr double kAmplitude_m = 0.05;
inline constexpr double kPoolSide_m = 12.0;

/// Walls all round; the lowest mode along x, from rest.
inline core::Scene seicheScene() {
  core::Scene scene;
  scene.name = "seiche";
  scene.wave.emplace();
  scene.wave->resolution_count = 64;
  scene.wave->side_m = kPoolSide_m;
  scene.wave->depth_m = 1.5;
  scene.wave->damping_per_s = 0.0;
  setBoundaries(*scene.wave, core::WaveBoundary::kReflect);
  return scene;
}

class SeicheOnDevice : public OnDevice {
 protected:
  static double wavenumber_radpm() { return std::numbers::pi / kPoolSide_m; }

  /// The mode at rest: the flow is that of half a step before.
  static void startSeiche(WaterSim& sim) {
    StateCopy state = sim.copyState();
    const WaveLayout w = *sim.derived().wave;
    const std::size_t n = w.count_x;
    const std::size_t components = state.flow_m2ps.size() / state.elevation_m.size();
    const auto eta = [&](std::size_t x) {
      return kAmplitude_m * std::cos(wavenumber_radpm() * (static_cast<double>(x) + 0.5) * w.cell_m);
    };
    const double half_kick = 0.5 * sim.scene().gravity_mps2 * sim.scene().wave->depth_m * w.dt_s / w.cell_m;
    for (std::size_t i = 0; i < n * n; ++i) {
      const std::size_t x = i % n;
      state.elevation_m[i] = eta(x);
      state.flow_m2ps[i * components] = x + 1 < n ? static_cast<float>(half_kick * (eta(x + 1) - eta(x))) : 0.0F;
    }
    sim.setState(state);
  }
};

}  // namespace spindrift::sim
