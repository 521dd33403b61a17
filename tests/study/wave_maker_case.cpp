// Wave-makers: the waves that they make beside those that were asked for, and what they send back of those that return.
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <spindrift/sim_setup/sea_state.h>

#include "cases.h"
#include "ticks.h"

namespace spindrift::study {
namespace {

using std::numbers::pi;
using Series = sim::GaugeHistory::Series;

constexpr double kGravity_mps2 = 9.81;
constexpr std::uint32_t kAcross = 4;  ///< cells across a flume

struct Water {
  const char* name;
  core::Bulk bulk;
  core::Dispersion dispersion;
};
constexpr Water kLinear{"linear", core::Bulk::kLinear, core::Dispersion::kNone};
constexpr Water kLinearDispersed{"linear, dispersed", core::Bulk::kLinear, core::Dispersion::kAiry};
constexpr Water kShallow{"nonlinear", core::Bulk::kNonlinear, core::Dispersion::kNone};
constexpr Water kShallowDispersed{"nonlinear, dispersed", core::Bulk::kNonlinear, core::Dispersion::kAiry};

/// A flume of water 1 m deep with a maker at -x; `absorbing_m`: width of a layer at the other end, 0 for a wall.
core::Scene flumeScene(const Water& water, double length_m, double cell_m, double absorbing_m, double tick_rate_hz) {
  core::Scene scene;
  scene.name = "flume";
  scene.gravity_mps2 = kGravity_mps2;
  scene.tick_rate_hz = tick_rate_hz;
  core::WaveScene& wave = scene.wave.emplace();
  wave.resolution_count = static_cast<std::uint32_t>(std::lround(length_m / cell_m));
  wave.side_m = wave.resolution_count * cell_m;
  wave.width_m = kAcross * cell_m;
  wave.depth_m = 1.0;
  wave.damping_per_s = 0.0;
  wave.manning_spm13 = 0.0;
  wave.bulk = water.bulk;
  wave.dispersion = water.dispersion;
  setBoundaries(wave, core::WaveBoundary::kReflect);
  if (absorbing_m > 0) {
    wave.boundary_plus_x = core::WaveBoundary::kAbsorb;
    wave.absorption = core::Absorption::kPml;
    wave.sponge_width_m = absorbing_m;
  }
  return scene;
}

/// Adds a gauge so many metres from the maker.
void addGauge(core::Scene& scene, double from_maker_m) {
  scene.gauges.push_back(
      {.name = fmt::format("g{}", scene.gauges.size()), .x_m = from_maker_m - 0.5 * scene.wave->side_m, .z_m = 0.0});
}

/// Runs the scene and returns what each gauge has read.
core::Result<std::vector<Series>> readingsOf(gpu::Context& ctx, const core::Scene& scene, double duration_s) {
  auto water = sim::WaterSim::create(ctx, scene);
  if (!water) return water.error();
  std::vector<Series> out(scene.gauges.size());
  const auto keep = [&] {
    const double known_s = out[0].time_s.empty() ? -1.0 : out[0].time_s.back();
    for (std::size_t g = 0; g < out.size(); ++g) {
      const Series now = (*water)->gauges()->series(g);
      for (std::size_t k = 0; k < now.time_s.size(); ++k) {
        if (now.time_s[k] <= known_s) continue;
        out[g].time_s.push_back(now.time_s[k]);
        out[g].readings.push_back(now.readings[k]);
      }
    }
  };
  int tick_count = 0;
  auto done = runTo(**water, duration_s, [&] {
    if (++tick_count % 2048 == 0) keep();
  });
  if (!done) return done.error();
  keep();
  return out;
}

/// Amplitude and phase of the elevation at a frequency between two times, by least squares with a constant.
std::complex<double> amplitudeOf(const Series& series, double omega_radps, double from_s, double to_s) {
  double mean = 0.0, count = 0.0;
  for (std::size_t k = 0; k < series.time_s.size(); ++k) {
    if (series.time_s[k] < from_s || series.time_s[k] > to_s) continue;
    mean += series.readings[k].elevation_m;
    count += 1;
  }
  mean /= count;
  double cc = 0, cs = 0, ss = 0, c = 0, s = 0;
  for (std::size_t k = 0; k < series.time_s.size(); ++k) {
    if (series.time_s[k] < from_s || series.time_s[k] > to_s) continue;
    const double a = std::cos(omega_radps * series.time_s[k]);
    const double b = std::sin(omega_radps * series.time_s[k]);
    const double eta = series.readings[k].elevation_m - mean;
    cc += a * a, cs += a * b, ss += b * b, c += a * eta, s += b * eta;
  }
  const double det = cc * ss - cs * cs;
  return {(c * ss - s * cs) / det, -(s * cc - c * cs) / det};
}

/// Height of regular waves far from the maker and their period; flume of 12 wavelengths with an absorbing end.
core::Result<void> regularWaves(gpu::Context& ctx, const Water& water, double depth_ratio, std::vector<Row>& rows) {
  const double length_m = 1.0 / depth_ratio;
  const double k_radpm = 2 * pi / length_m;
  const bool disperses = water.dispersion == core::Dispersion::kAiry;
  const double omega = disperses ? sim::waveFrequency(k_radpm, kGravity_mps2, 1.0) : k_radpm * std::sqrt(kGravity_mps2);
  const double period_s = 2 * pi / omega;
  // Low enough that they keep their form over the gauges.
  const double height_m = std::min(0.004, 0.004 * length_m);
  constexpr double kCellsPerWave = 20.0;
  core::Scene scene =
      flumeScene(water, 12 * length_m, length_m / kCellsPerWave, 2 * length_m, std::clamp(40 / period_s, 10.0, 240.0));
  scene.wave_makers = {core::WaveMaker{.side = core::Side::kMinusX,
                                       .waves = core::RegularWaves{.height_m = height_m, .period_s = period_s}}};
  for (double waves = 2.0; waves < 4.99; waves += 0.25) addGauge(scene, waves * length_m);
  // The slowest part of the beginning, at the group speed, has passed all gauges.
  const double from_s = 32 * period_s;
  const double to_s = 42 * period_s;
  const auto readings = readingsOf(ctx, scene, to_s);
  if (!readings) return readings.error();
  double sum_m = 0.0;
  for (const Series& series : *readings) sum_m += 2 * std::abs(amplitudeOf(series, omega, from_s, to_s));
  const double middle_s = 0.5 * (from_s + to_s);
  const std::complex<double> early = amplitudeOf(readings->front(), omega, from_s, middle_s);
  const std::complex<double> late = amplitudeOf(readings->front(), omega, middle_s, to_s);
  const double turned = std::arg(late / early) / (omega * 5 * period_s);
  const std::string name = fmt::format("{}, regular waves, depth / length {:.2f}", water.name, depth_ratio);
  rows.push_back({name + ": height / wanted", "", sum_m / static_cast<double>(readings->size()) / height_m, 1.0,
                  Tolerance::kRelative, 0.03, "what the maker was asked for"});
  rows.push_back({name + ": period / wanted", "", 1.0 / (1.0 + turned), 1.0, Tolerance::kRelative, 0.001, "the same"});
  return {};
}

/// Regular waves high enough for a second harmonic: that which is bound to them, as in waves of permanent form (Stokes
/// 1847), and the free one, which the maker should not make.
core::Result<void> secondHarmonic(gpu::Context& ctx, std::vector<Row>& rows) {
  constexpr double kHeight_m = 0.05;
  constexpr double kWaveNumber = 0.67;
  const double length_m = 2 * pi / kWaveNumber;
  const double omega = sim::waveFrequency(kWaveNumber, kGravity_mps2, 1.0);
  const double period_s = 2 * pi / omega;
  core::Scene scene = flumeScene(kShallowDispersed, 8 * length_m, length_m / 60, 2 * length_m, 30.0);
  scene.wave_makers = {core::WaveMaker{.side = core::Side::kMinusX,
                                       .waves = core::RegularWaves{.height_m = kHeight_m, .period_s = period_s}}};
  std::vector<double> places_m;
  for (double waves = 0.75; waves < 4.0; waves += 0.2) places_m.push_back(waves * length_m);
  for (const double x : places_m) addGauge(scene, x);
  const double from_s = 18 * period_s;
  const auto readings = readingsOf(ctx, scene, from_s + 6 * period_s);
  if (!readings) return readings.error();
  // Two waves by least squares.
  const double free_k = sim::waveNumber(2 * omega, kGravity_mps2, 1.0);
  std::complex<double> both, to_bound, to_free;
  for (std::size_t g = 0; g < places_m.size(); ++g) {
    const std::complex<double> measured = amplitudeOf((*readings)[g], 2 * omega, from_s, from_s + 6 * period_s);
    const auto bound = std::polar(1.0, -2 * kWaveNumber * places_m[g]);
    const auto free_wave = std::polar(1.0, -free_k * places_m[g]);
    both += std::conj(bound) * free_wave;
    to_bound += std::conj(bound) * measured;
    to_free += std::conj(free_wave) * measured;
  }
  const auto count = static_cast<double>(places_m.size());
  const double det = count * count - std::norm(both);
  const double bound_m = std::abs(count * to_bound - both * to_free) / det;
  const double free_m = std::abs(count * to_free - std::conj(both) * to_bound) / det;
  const double t = std::tanh(kWaveNumber);
  const double wanted_m = kWaveNumber * kHeight_m * kHeight_m / 16 * (3 - t * t) / (t * t * t);
  rows.push_back({"nonlinear, dispersed, regular waves of 0.05 depths: bound second harmonic / that of Stokes", "",
                  bound_m / wanted_m, 1.0, Tolerance::kRelative, 0.15, "waves of permanent form"});
  rows.push_back({"the same: free second harmonic / bound one", "", free_m / wanted_m, 0.3, Tolerance::kAtMost, 0.0,
                  "the maker makes none; 1.3 from a maker of first order"});
  return {};
}

/// A maker that faces a wall: the standing wave is as high after 60 periods as after 30.
core::Result<void> standingWaves(gpu::Context& ctx, const Water& water, double depth_ratio, std::vector<Row>& rows) {
  const double length_m = 1.0 / depth_ratio;
  const bool disperses = water.dispersion == core::Dispersion::kAiry;
  const double k_radpm = 2 * pi / length_m;
  const double omega = disperses ? sim::waveFrequency(k_radpm, kGravity_mps2, 1.0) : k_radpm * std::sqrt(kGravity_mps2);
  const double period_s = 2 * pi / omega;
  const double height_m = std::min(0.004, 0.004 * length_m);
  core::Scene scene = flumeScene(water, 4.25 * length_m, length_m / 20, 0.0, std::clamp(40 / period_s, 10.0, 240.0));
  scene.wave_makers = {core::WaveMaker{.side = core::Side::kMinusX,
                                       .waves = core::RegularWaves{.height_m = height_m, .period_s = period_s}}};
  addGauge(scene, scene.wave->side_m - 0.5 * scene.wave->side_m / scene.wave->resolution_count);
  const auto readings = readingsOf(ctx, scene, 60 * period_s);
  if (!readings) return readings.error();
  const double early_m = 2 * std::abs(amplitudeOf(readings->front(), omega, 25 * period_s, 30 * period_s));
  const double late_m = 2 * std::abs(amplitudeOf(readings->front(), omega, 55 * period_s, 60 * period_s));
  const std::string name = fmt::format("{}, before a wall, depth / length {:.2f}", water.name, depth_ratio);
  rows.push_back({name + ": height after 60 over that after 30 periods", "", late_m / early_m, 1.02, Tolerance::kAtMost,
                  0.0, "does not grow: what comes back is taken up"});
  rows.push_back({name + ": height at the wall / twice that of the waves", "", late_m / (2 * height_m), 1.0,
                  Tolerance::kRelative, 0.2, "1, and what the maker sends back again"});
  return {};
}

core::Result<void> solitaryWaves(gpu::Context& ctx, double height_m, std::vector<Row>& rows) {
  const double speed_mps = std::sqrt(kGravity_mps2 * (1 + height_m));
  core::Scene scene = flumeScene(kShallowDispersed, 60.0, 0.1, 0.0, 60.0);
  scene.wave_makers = {core::WaveMaker{.side = core::Side::kMinusX, .waves = core::SolitaryWave{.height_m = height_m}}};
  constexpr std::array<double, 3> kGauges_m = {5.0, 15.0, 30.0};
  for (const double x : kGauges_m) addGauge(scene, x);
  const double begin_s = 5.0 / (std::sqrt(0.75 * height_m / (1 + height_m)) * speed_mps);
  const auto readings = readingsOf(ctx, scene, begin_s + 38.0 / speed_mps);
  if (!readings) return readings.error();
  for (std::size_t g = 0; g < kGauges_m.size(); ++g) {
    double highest_m = 0.0;
    for (const sim::GaugeReading& each : (*readings)[g].readings)
      highest_m = std::max(highest_m, double{each.elevation_m});
    rows.push_back(
        {fmt::format("solitary wave, H/d = {}: height {} depths from the maker / wanted", height_m, kGauges_m[g]), "",
         highest_m / height_m, 1.0, Tolerance::kRelative, 0.05, "what the maker was asked for"});
  }
  return {};
}

/// Significant height and peak period of irregular waves.
core::Result<void> irregularWaves(gpu::Context& ctx, const Water& water, std::vector<Row>& rows) {
  const double peak_s = 3.0;
  const double length_m = 2 * pi / sim::waveNumber(2 * pi / peak_s, kGravity_mps2, 1.0);
  const double height_m = 0.03;
  core::Scene scene = flumeScene(water, 10 * length_m, length_m / 40, 3 * length_m, 20.0);
  scene.wave_makers = {
      core::WaveMaker{.side = core::Side::kMinusX,
                      .waves = core::IrregularWaves{.significant_height_m = height_m, .peak_period_s = peak_s}}};
  addGauge(scene, 3 * length_m);
  addGauge(scene, 5 * length_m);
  const double from_s = 20 * peak_s;
  const double to_s = from_s + 1000 * peak_s;
  const auto readings = readingsOf(ctx, scene, to_s);
  if (!readings) return readings.error();
  double variance_m2 = 0.0, count = 0.0;
  for (const Series& series : *readings) {
    for (std::size_t k = 0; k < series.time_s.size(); ++k) {
      if (series.time_s[k] < from_s) continue;
      variance_m2 += double{series.readings[k].elevation_m} * series.readings[k].elevation_m;
      count += 1;
    }
  }
  // Energy in bands of 4 % of the peak's frequency; the peak by the fourth power, which chance moves less than the
  // largest band.
  double weights = 0.0, weighted = 0.0;
  for (double ratio = 0.5; ratio < 2.0; ratio += 0.04) {
    double energy = 0.0;
    for (int part = 0; part < 8; ++part) {
      const double omega = 2 * pi / peak_s * (ratio + 0.005 * part - 0.02);
      for (const Series& series : *readings) energy += std::norm(amplitudeOf(series, omega, from_s, to_s));
    }
    weights += std::pow(energy, 4);
    weighted += std::pow(energy, 4) * ratio;
  }
  const std::string name = fmt::format("{}, JONSWAP", water.name);
  rows.push_back({name + ": significant height / wanted", "", 4 * std::sqrt(variance_m2 / count) / height_m, 1.0,
                  Tolerance::kRelative, 0.05, "four standard deviations at two gauges"});
  rows.push_back({name + ": peak period / wanted", "", weights / weighted, 1.0, Tolerance::kRelative, 0.05,
                  "spectrum at the gauges, weighted by its fourth power"});
  return {};
}

/// A series: what passes a gauge two depths from the maker, against the linear waves of the given series there.
core::Result<void> givenSeries(gpu::Context& ctx, const Water& water, std::vector<Row>& rows) {
  core::ElevationSeries series;
  const auto given = [](double t) {
    const double far = (t - 20.0) / 6.0;
    return 0.01 * std::exp(-far * far) * (std::cos(2 * pi / 5.0 * (t - 20.0)) + 0.4 * std::sin(2 * pi / 8.0 * t));
  };
  constexpr double kStep_s = 0.1;
  constexpr double kEnd_s = 40.0;
  for (double t = 0.0; t <= kEnd_s; t += kStep_s) {
    series.time_s.push_back(t);
    series.elevation_m.push_back(given(t));
  }
  core::Scene scene = flumeScene(water, 60.0, 0.25, 15.0, 30.0);
  scene.wave_makers = {core::WaveMaker{.side = core::Side::kMinusX, .waves = series}};
  constexpr double kGauge_m = 2.125;
  addGauge(scene, kGauge_m);
  const auto readings = readingsOf(ctx, scene, 45.0);
  if (!readings) return readings.error();
  // The series as a sum of waves over a time in which they do not overlap, each at its own speed.
  constexpr double kSpan_s = 80.0;
  std::vector<std::pair<double, std::complex<double>>> waves;
  for (int n = 1; 2 * pi * n / kSpan_s < 5.0; ++n) {
    const double omega = 2 * pi * n / kSpan_s;
    std::complex<double> sum;
    for (double t = 0.0; t <= kEnd_s; t += kStep_s) sum += given(t) * std::polar(2 * kStep_s / kSpan_s, -omega * t);
    const double k = water.dispersion == core::Dispersion::kAiry ? sim::waveNumber(omega, kGravity_mps2, 1.0)
                                                                 : omega / std::sqrt(kGravity_mps2);
    waves.emplace_back(omega, sum * std::polar(1.0, -k * kGauge_m));
  }
  double off = 0.0, all = 0.0;
  for (std::size_t k = 0; k < readings->front().time_s.size(); ++k) {
    double wanted = 0.0;
    for (const auto& [omega, strength] : waves)
      wanted += (strength * std::polar(1.0, omega * readings->front().time_s[k])).real();
    off += std::pow(readings->front().readings[k].elevation_m - wanted, 2);
    all += wanted * wanted;
  }
  rows.push_back({fmt::format("{}, series: root mean square error two depths from the maker", water.name), "%",
                  100 * std::sqrt(off / all), 3.0, Tolerance::kAtMost, 0.0,
                  "the series that was given, as linear waves"});
  return {};
}

}  // namespace

Outcome waveMakers(gpu::Context& ctx, bool quick) {
  std::vector<Row> rows;
  core::Result<void> done;
  const auto next = [&](auto measure) {
    if (done) done = measure();
  };
  /// The quick form has one row of each kind of wave that takes few seconds.
  struct Run {
    Water water;
    double depth_ratio;
    bool is_quick;
  };
  for (const Run& run : {Run{kLinear, 0.03, true},
                         {kShallow, 0.03, false},
                         {kLinearDispersed, 0.15, false},
                         {kShallowDispersed, 0.05, false},
                         {kShallowDispersed, 0.15, true},
                         {kShallowDispersed, 0.4, false}})
    if (run.is_quick || !quick) next([&] { return regularWaves(ctx, run.water, run.depth_ratio, rows); });
  next([&] { return secondHarmonic(ctx, rows); });
  for (const Run& run : {Run{kShallow, 0.03, false},
                         {kShallowDispersed, 0.05, false},
                         {kShallowDispersed, 0.15, true},
                         {kShallowDispersed, 0.4, false}})
    if (run.is_quick || !quick) next([&] { return standingWaves(ctx, run.water, run.depth_ratio, rows); });
  if (!quick) next([&] { return solitaryWaves(ctx, 0.1, rows); });
  next([&] { return solitaryWaves(ctx, 0.3, rows); });
  if (!quick) next([&] { return irregularWaves(ctx, kShallowDispersed, rows); });
  if (!quick) next([&] { return givenSeries(ctx, kShallow, rows); });
  next([&] { return givenSeries(ctx, kShallowDispersed, rows); });
  if (!done) return done.error();
  return CaseResult{std::move(rows), {}};
}

}  // namespace spindrift::study
