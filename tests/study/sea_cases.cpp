// The wind sea that comes in at open sides: what arrives in the middle of the water, beside the spectrum and Airy's
// theory.
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include <spindrift/sim_setup/sea_state.h>

#include "cases.h"
#include "ticks.h"

namespace spindrift::study {
namespace {

using core::WaveBoundary;
using std::numbers::pi;
using Complex = std::complex<double>;

/// Times of the measurement: the slowest waves have crossed the water; then samples every so many ticks.
constexpr double kFilled_s = 50.0;
constexpr int kSampleTicks = 6;
/// Half of the square in the middle that is measured, and the distance of its samples.
constexpr double kMiddleHalf_m = 6.0;
constexpr int kSampleCells = 4;

/// Open water of 30 m without rain and damping, with the wind of scene open_water at full storm.
core::Scene openSea(bool quick) {
  core::Scene scene;
  scene.name = "sea";
  scene.wave.emplace();
  core::WaveScene& wave = *scene.wave;
  wave.resolution_count = quick ? 128 : 256;
  wave.side_m = 30.0;
  wave.depth_m = 2.0;
  wave.damping_per_s = 0.0;
  wave.sponge_width_m = 4.0;
  wave.dispersion = core::Dispersion::kAiry;
  setBoundaries(wave, WaveBoundary::kAbsorb);
  scene.storm.emplace();
  scene.storm->level_ratio = 1.0;
  scene.storm->drops_per_m2_s = 0.0;
  scene.storm->wave_height_m = 0.5;
  scene.storm->wind_direction_deg = 30.0;
  return scene;
}

/// Elevations in a square at several times.
struct Samples {
  struct Place {
    double x_m, z_m;
    std::size_t cell;
  };
  std::vector<Place> places;
  std::vector<double> times_s;
  std::vector<std::vector<double>> eta_m;  ///< by time, then position

  [[nodiscard]] double variance_m2() const {
    double sum = 0.0;
    for (const auto& at_time : eta_m)
      for (const double eta : at_time) sum += eta * eta;
    return sum / static_cast<double>(eta_m.size() * places.size());
  }
};

/// Samples of the square around (x, z) from the time at which the sea has filled the water.
core::Result<Samples> sample(sim::WaterSim& water, double x_m, double z_m, double half_m, double for_s) {
  const sim::WaveLayout& layout = *water.derived().wave;
  const std::size_t nx = layout.count_x;
  Samples out;
  for (std::size_t z = 0; z < layout.count_z; z += kSampleCells) {
    for (std::size_t x = 0; x < nx; x += kSampleCells) {
      const double px = (static_cast<double>(x) + 0.5) * layout.cell_m - layout.length_m / 2;
      const double pz = (static_cast<double>(z) + 0.5) * layout.cell_m - layout.width_m / 2;
      if (std::abs(px - x_m) < half_m && std::abs(pz - z_m) < half_m) out.places.push_back({px, pz, x + nx * z});
    }
  }
  if (auto done = runTo(water, kFilled_s); !done) return done.error();
  int ticks = 0;
  auto done = runTo(water, kFilled_s + for_s, [&] {
    if (++ticks % kSampleTicks != 0) return;
    const std::vector<double> eta_m = water.copyState().elevation_m;
    out.times_s.push_back(water.time_s());
    auto& row = out.eta_m.emplace_back();
    for (const Samples::Place& place : out.places) row.push_back(eta_m[place.cell]);
  });
  if (!done) return done.error();
  return out;
}

/// Solves a x = b for a symmetric positive matrix (Cholesky). Both are overwritten.
std::vector<double> solve(std::vector<std::vector<double>> a, std::vector<double> b) {
  const std::size_t n = b.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = a[i][j];
      for (std::size_t k = 0; k < j; ++k) sum -= a[i][k] * a[j][k];
      a[i][j] = i == j ? std::sqrt(sum) : sum / a[j][j];
    }
    for (std::size_t k = 0; k < i; ++k) b[i] -= a[i][k] * b[k];
    b[i] /= a[i][i];
  }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t k = i + 1; k < n; ++k) b[i] -= a[k][i] * b[k];
    b[i] /= a[i][i];
  }
  return b;
}

/// Amplitudes of the sea's waves that fit the samples best, over those of theory: 1 is perfect.
struct Fit {
  std::vector<Complex> ratio;
  double explained_share = 0.0;  ///< of the variance
};

Fit fit(const Samples& samples, const std::vector<sim::PlaneWave>& waves) {
  const std::size_t count = 2 * waves.size();
  std::vector<std::vector<double>> normal(count, std::vector<double>(count, 0.0));
  std::vector<double> right(count, 0.0);
  std::vector<double> basis(count);
  for (std::size_t t = 0; t < samples.times_s.size(); ++t) {
    for (std::size_t p = 0; p < samples.places.size(); ++p) {
      for (std::size_t w = 0; w < waves.size(); ++w) {
        const double turn = waves[w].kx_radpm * samples.places[p].x_m + waves[w].kz_radpm * samples.places[p].z_m -
                            waves[w].omega_radps * samples.times_s[t] + waves[w].phase_rad;
        basis[2 * w] = waves[w].amplitude_m * std::cos(turn);
        basis[2 * w + 1] = waves[w].amplitude_m * std::sin(turn);
      }
      for (std::size_t i = 0; i < count; ++i) {
        right[i] += basis[i] * samples.eta_m[t][p];
        for (std::size_t j = 0; j <= i; ++j) normal[i][j] += basis[i] * basis[j];
      }
    }
  }
  const std::vector<double> best = solve(normal, right);
  Fit out;
  double explained = 0.0;
  for (std::size_t i = 0; i < count; ++i) explained += best[i] * right[i];
  for (std::size_t w = 0; w < waves.size(); ++w) out.ratio.emplace_back(best[2 * w], best[2 * w + 1]);
  out.explained_share =
      explained / (samples.variance_m2() * static_cast<double>(samples.times_s.size() * samples.places.size()));
  return out;
}

}  // namespace

Outcome windSea(gpu::Context& ctx, bool quick) {
  const core::Scene scene = openSea(quick);
  auto made = sim::WaterSim::create(ctx, scene);
  if (!made) return made.error();
  sim::WaterSim& water = **made;
  const sim::SeaState sea = sim::seaState(scene, *water.derived().wave);
  const auto samples = sample(water, 0.0, 0.0, kMiddleHalf_m, quick ? 40.0 : 120.0);
  if (!samples) return samples.error();
  const Fit found = fit(*samples, sea.waves);

  // Moments over the waves, with the energy that each of them has in the middle.
  double energy = 0.0, wanted_energy = 0.0, frequency = 0.0, wanted_frequency = 0.0, slowness = 0.0;
  Complex direction, wanted_direction;
  for (std::size_t w = 0; w < sea.waves.size(); ++w) {
    const sim::PlaneWave& wave = sea.waves[w];
    const double share = std::norm(found.ratio[w]);
    const Complex along = std::polar(1.0, std::atan2(wave.kz_radpm, wave.kx_radpm));
    energy += share;
    wanted_energy += 1.0;
    frequency += share * wave.omega_radps;
    wanted_frequency += wave.omega_radps;
    direction += share * along;
    wanted_direction += along;
    // The phase that a wave lacks in the middle, over its whole phase since the side.
    const double way_m = scene.wave->side_m / 2 * (std::abs(along.real()) + std::abs(along.imag()));
    const double phase = std::arg(found.ratio[w]);
    slowness += share * std::pow(phase / (std::hypot(wave.kx_radpm, wave.kz_radpm) * way_m), 2);
  }
  const double height_m = 4 * std::sqrt(samples->variance_m2());
  const std::string source = "sum of the sea's plane waves";
  std::vector<Row> rows;
  rows.push_back({"significant height in the middle, plane waves of the sea", "m",
                  4 * std::sqrt(found.explained_share * samples->variance_m2()), sea.significant_height_m,
                  Tolerance::kRelative, 0.10, source});
  rows.push_back({"significant height in the middle, everything", "m", height_m, sea.significant_height_m,
                  Tolerance::kRelative, 0.10, source});
  rows.push_back({"mean period in the middle, m0/m1", "s", 2 * pi * energy / frequency,
                  2 * pi * wanted_energy / wanted_frequency, Tolerance::kRelative, 0.02, source});
  rows.push_back({"mean direction in the middle", "deg", std::arg(direction) * 180 / pi,
                  std::arg(wanted_direction) * 180 / pi, Tolerance::kAbsolute, 2.0, source});
  rows.push_back({"variance in plane waves of Airy's lengths", "%", 100 * found.explained_share, 95.0,
                  Tolerance::kAtLeast, 0.0, "omega^2 = g k tanh(k d)"});
  rows.push_back({"phase speed, root mean square error over the waves", "%", 100 * std::sqrt(slowness / energy), 1.5,
                  Tolerance::kAtMost, 0.0, "omega^2 = g k tanh(k d)"});
  return CaseResult{std::move(rows), {}};
}

}  // namespace spindrift::study
