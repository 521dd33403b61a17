#include "wave_modes.h"

#include <algorithm>
#include <cmath>

#include "ticks.h"

namespace spindrift::study {

core::Scene waveScene(std::uint32_t resolution_count, double side_m, double depth_m, double courant,
                      core::Stencil stencil, core::WaveBoundary sides) {
  core::Scene scene;
  scene.name = "wave";
  scene.wave.emplace();
  core::WaveScene& wave = *scene.wave;
  wave.resolution_count = resolution_count;
  wave.side_m = side_m;
  wave.depth_m = depth_m;
  wave.damping_per_s = 0.0;
  wave.stencil = stencil;
  setBoundaries(wave, sides);
  scene.tick_rate_hz = std::sqrt(scene.gravity_mps2 * depth_m) / (courant * side_m / resolution_count);
  return scene;
}

core::Scene dispersiveScene(std::uint32_t resolution_count, double cell_m, double depth_m, core::WaveBoundary sides,
                            double tick_rate_hz) {
  core::Scene scene;
  scene.name = "dispersive wave";
  scene.tick_rate_hz = tick_rate_hz;
  scene.wave.emplace();
  core::WaveScene& wave = *scene.wave;
  wave.resolution_count = resolution_count;
  wave.side_m = resolution_count * cell_m;
  wave.depth_m = depth_m;
  wave.damping_per_s = 0.0;
  wave.fixed_substeps_count = 1;
  wave.dispersion = core::Dispersion::kAiry;
  setBoundaries(wave, sides);
  return scene;
}

void setSurface(sim::WaterSim& water, const std::function<double(double, double)>& eta_m) {
  sim::StateCopy state = water.copyState();
  const sim::WaveLayout wave = *water.derived().wave;
  const std::size_t nx = wave.count_x;
  for (std::size_t z = 0; z < wave.count_z; ++z) {
    for (std::size_t x = 0; x < nx; ++x)
      state.elevation_m[x + nx * z] =
          eta_m((static_cast<double>(x) + 0.5) * wave.cell_m, (static_cast<double>(z) + 0.5) * wave.cell_m);
  }
  std::ranges::fill(state.flow_m2ps, 0.0f);
  water.setState(state);
}

core::Result<std::vector<double>> amplitudes(sim::WaterSim& water, const std::function<double(double, double)>& mode,
                                             int steps) {
  const sim::WaveLayout wave = *water.derived().wave;
  const std::size_t nx = wave.count_x;
  std::vector<double> shape(wave.counts().total());
  double norm = 0.0;
  for (std::size_t z = 0; z < wave.count_z; ++z) {
    for (std::size_t x = 0; x < nx; ++x) {
      double& value = shape[x + nx * z];
      value = mode((static_cast<double>(x) + 0.5) * wave.cell_m, (static_cast<double>(z) + 0.5) * wave.cell_m);
      norm += value * value;
    }
  }
  std::vector<double> out;
  for (int step = 0; step < steps; ++step) {
    if (auto done = tick(water); !done) return done.error();
    const std::vector<double> eta_m = water.copyState().elevation_m;
    double sum = 0.0;
    for (std::size_t i = 0; i < eta_m.size(); ++i) sum += eta_m[i] * shape[i];
    out.push_back(sum / norm);
  }
  return out;
}

double Recurrence::omega_radps(double dt_s) const {
  return std::acos(std::clamp(b / (2 * std::sqrt(r)), -1.0, 1.0)) / dt_s;
}

double Recurrence::decayRate_ps(double dt_s) const {
  return -0.5 * std::log(r) / dt_s;
}

Recurrence fitRecurrence(const std::vector<double>& series, bool undamped) {
  // Normal equations of a_{n+1} = b a_n - r a_{n-1}.
  double now2 = 0, before2 = 0, cross = 0, next_now = 0, next_before = 0;
  for (std::size_t i = 1; i + 1 < series.size(); ++i) {
    const double before = series[i - 1];
    const double now = series[i];
    const double next = series[i + 1];
    now2 += now * now;
    before2 += before * before;
    cross += now * before;
    next_now += next * now;
    next_before += next * before;
  }
  if (undamped) return {(next_now + cross) / now2, 1.0};
  const double det = now2 * before2 - cross * cross;
  return {(next_now * before2 - next_before * cross) / det, -(next_before * now2 - next_now * cross) / det};
}

}  // namespace spindrift::study
