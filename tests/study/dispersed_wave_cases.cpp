// Waves that disperse, over an even bed: phase speed, group speed, rings.
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

#include <fmt/format.h>

#include "cases.h"
#include "exact_linear_waves.h"
#include "ticks.h"
#include "wave_modes.h"
#include "wave_packet.h"

namespace spindrift::study {
namespace {

using core::WaveBoundary;
using std::numbers::pi;

constexpr double kCell_m = 0.125;
/// Largest errors of the phase speed that the coefficients were fitted for: waves of 8 cells and longer, and of 4 to 8.
constexpr double kMostFrom8Cells_percent = 1.0;
constexpr double kMostFrom4Cells_percent = 2.5;
constexpr double kLongestFitted_cells = 128.5;
constexpr double kMostKd = 10.0;
constexpr const char* kAirySource = "omega^2 = g k tanh(k d)";

/// Water of one depth, and the side of the square [cells]: deep water needs a wide one, because the coarsest grid of
/// the V-cycle has at least 4 x 4 cells.
struct AiryDepth {
  double depth_cells;
  std::uint32_t resolution_count;
};
constexpr AiryDepth kAiryDepths[] = {
    {3.0, 64},
    {7.2, 64},
    {16.0, 128},
    {40.0, 256},
};
constexpr std::uint32_t kLongSide = 384;  ///< of the full form, for longer waves

/// Standing wave of p half waves between the sides, along one axis or both.
struct StandingWave {
  int half_waves = 1;
  bool is_diagonal = false;

  [[nodiscard]] double k_radpm(double side_m) const {
    return pi * half_waves / side_m * (is_diagonal ? std::numbers::sqrt2 : 1.0);
  }
};

/// Waves along the axis and along the diagonal, from 4 cells to twice the side. `few`: a quarter of them.
std::vector<StandingWave> standingWaves(std::uint32_t resolution_count, bool few) {
  std::vector<StandingWave> out;
  for (const bool is_diagonal : {false, true}) {
    const int most = static_cast<int>(resolution_count / (is_diagonal ? 2.85 : 2.0));
    double half_waves = most;
    while (half_waves >= 0.99) {
      out.push_back({static_cast<int>(half_waves), is_diagonal});
      half_waves = std::floor(half_waves * (few ? 0.35 : 0.71));
    }
  }
  return out;
}

/// Frequency of a standing wave between reflecting sides, from the recurrence of its amplitude over a quarter of a
/// period.
core::Result<double> frequencyOf(sim::WaterSim& water, const StandingWave& wave, double expected_radps,
                                 int most_steps) {
  const sim::WaveLayout& layout = *water.derived().wave;
  const double k_radpm = pi * wave.half_waves / layout.length_m;
  const auto mode = [&](double x, double z) {
    return std::cos(k_radpm * x) * (wave.is_diagonal ? std::cos(k_radpm * z) : 1.0);
  };
  setSurface(water, [&](double x, double z) { return 0.01 * mode(x, z); });
  const int steps = std::clamp(static_cast<int>(0.5 * pi / (expected_radps * layout.dt_s)), 30, most_steps);
  const auto series = amplitudes(water, mode, steps);
  if (!series) return series.error();
  return fitRecurrence(*series, true).omega_radps(layout.dt_s);
}

constexpr std::uint32_t kSplitSide = 64;

/// Difference in frequency [%] between the two standing waves of a length along the axis, with crests on the edges of
/// the V-cycle's blocks and a quarter of a wave away: on water without sides they should be one.
core::Result<double> splitBy(gpu::Context& ctx, double depth_cells, int wave_count) {
  auto made =
      sim::WaterSim::create(ctx, dispersiveScene(kSplitSide, kCell_m, depth_cells * kCell_m, WaveBoundary::kPeriodic));
  if (!made) return made.error();
  sim::WaterSim& water = **made;
  std::array<double, 2> omega_radps{};
  for (std::size_t k = 0; k < 2; ++k) {
    const auto mode = [&](double x, double) {
      return std::cos(2 * pi * wave_count * x / (kSplitSide * kCell_m) + 0.5 * pi * static_cast<double>(k));
    };
    setSurface(water, [&](double x, double z) { return 0.01 * mode(x, z); });
    const auto series = amplitudes(water, mode, 40);
    if (!series) return series.error();
    omega_radps[k] = fitRecurrence(*series, true).omega_radps(water.derived().wave->dt_s);
  }
  return 100 * std::abs(omega_radps[1] / omega_radps[0] - 1);
}

}  // namespace

Outcome airyPhaseSpeed(gpu::Context& ctx, bool quick) {
  std::vector<Row> rows;
  Figure figure{.name = "airy",
                .title = "Frequency of plane waves",
                .x_label = "k d [-]",
                .y_label = "omega sqrt(d/g) [-]",
                .is_logarithmic = true,
                .curves = {{"omega^2 = g k tanh(k d)", {}}}};
  for (int i = 0; i < 60; ++i) {
    const double kd = 0.04 * std::pow(1.1, i);
    figure.curves.front().points.emplace_back(kd, std::sqrt(kd * std::tanh(kd)));
  }
  for (const AiryDepth& depth : kAiryDepths) {
    Figure::Curve curve{fmt::format("water {} cells deep", depth.depth_cells), {}, true};
    // Largest errors [%] by direction: 4 to 8 cells a wave, 8 to 128, longer.
    std::array<std::array<double, 3>, 2> most{};
    for (const std::uint32_t n : {depth.resolution_count, kLongSide}) {
      if (n == kLongSide && (quick || depth.depth_cells > 8)) continue;
      auto water =
          sim::WaterSim::create(ctx, dispersiveScene(n, kCell_m, depth.depth_cells * kCell_m, WaveBoundary::kReflect));
      if (!water) return water.error();
      const AiryWater exact{(*water)->scene().gravity_mps2, depth.depth_cells * kCell_m};
      for (const StandingWave& wave : standingWaves(n, quick)) {
        const double k_radpm = wave.k_radpm(n * kCell_m);
        const double cells = 2 * pi / (k_radpm * kCell_m);
        const double kd = k_radpm * exact.depth_m;
        if (kd > kMostKd || cells < 3.99) continue;
        if (n != depth.resolution_count && cells <= 2.0 * depth.resolution_count) continue;  // measured already
        const double expected = exact.omega_radps(k_radpm);
        auto omega = frequencyOf(**water, wave, expected, quick ? 40 : 200);
        if (!omega) return omega.error();
        double& worst = most[wave.is_diagonal ? 1 : 0][cells < 7.99 ? 0 : cells < kLongestFitted_cells ? 1 : 2];
        worst = std::max(worst, 100 * std::abs(*omega / expected - 1));
        curve.points.emplace_back(kd, *omega * std::sqrt(exact.depth_m / exact.gravity_mps2));
      }
    }
    for (const bool is_diagonal : {false, true}) {
      const char* lengths[] = {"4 to 8 cells", "8 to 128 cells", "more than 128 cells"};
      const double bounds[] = {kMostFrom4Cells_percent, kMostFrom8Cells_percent, kMostFrom8Cells_percent};
      for (std::size_t k = 0; k < 3; ++k) {
        const double error_percent = most[is_diagonal ? 1 : 0][k];
        if (error_percent == 0.0) continue;  // none with kd up to 10 in this water
        rows.push_back({fmt::format("{} cells deep, {} a wave, along the {}: phase speed off", depth.depth_cells,
                                    lengths[k], is_diagonal ? "diagonal" : "axis"),
                        "%", error_percent, bounds[k], Tolerance::kAtMost, 0.0, kAirySource});
      }
    }
    figure.curves.push_back(std::move(curve));
  }
  for (const double depth_cells : {3.0, 8.0}) {
    for (const int wave_count : {8, 6, 4}) {
      auto split = splitBy(ctx, depth_cells, wave_count);
      if (!split) return split.error();
      rows.push_back({fmt::format("{} cells deep, {:.1f} cells a wave, crests on edges of blocks or not: difference",
                                  depth_cells, static_cast<double>(kSplitSide) / wave_count),
                      "%", *split, 1.0, Tolerance::kAtMost, 0.0, "one frequency"});
    }
  }
  return CaseResult{std::move(rows), {std::move(figure)}};
}

Outcome rippleSpeed(gpu::Context& ctx, bool quick) {
  constexpr double kRippleCell_m = 0.002;
  constexpr std::uint32_t kRippleSide = 64;
  constexpr double kTension_npm = 0.0728;
  core::Scene scene = dispersiveScene(kRippleSide, kRippleCell_m, 0.05, WaveBoundary::kReflect, 500.0);
  scene.wave->surface_tension_npm = kTension_npm;
  auto water = sim::WaterSim::create(ctx, scene);
  if (!water) return water.error();
  const AiryWater exact{scene.gravity_mps2, scene.wave->depth_m, kTension_npm / 1000};
  std::vector<Row> rows;
  Figure figure{.name = "ripples",
                .title = "Phase speed of ripples",
                .x_label = "wavelength [m]",
                .y_label = "phase speed [m/s]",
                .is_logarithmic = true,
                .curves = {{"c^2 = (g/k + sigma k/rho) tanh(k d)", {}}}};
  for (double wavelength_m = 0.008; wavelength_m < 0.13; wavelength_m *= 1.05)
    figure.curves.front().points.emplace_back(wavelength_m, exact.phaseSpeed_mps(2 * pi / wavelength_m));
  double slowest_mps = 1e9;
  for (const bool is_diagonal : {false, true}) {
    Figure::Curve curve{is_diagonal ? "along the diagonal" : "along the axis", {}, true};
    // Along the axis 15 half waves are 1.71 cm, along the diagonal 11 are 1.65 cm.
    for (const int half_waves : {3, 6, 9, 11, 13, 15, 17, 19, 24, 28}) {
      const StandingWave wave{half_waves, is_diagonal};
      const double k_radpm = wave.k_radpm(scene.wave->side_m);
      const double cells = 2 * pi / (k_radpm * kRippleCell_m);
      if (cells < 4.5 || (quick && half_waves % 2 == 0)) continue;
      const double expected_mps = exact.phaseSpeed_mps(k_radpm);
      auto omega = frequencyOf(**water, wave, expected_mps * k_radpm, 100);
      if (!omega) return omega.error();
      const double speed_mps = *omega / k_radpm;
      slowest_mps = std::min(slowest_mps, speed_mps);
      rows.push_back({fmt::format("waves of {:.2f} cm, {:.1f} cells, along the {}: phase speed", 2e2 * pi / k_radpm,
                                  cells, is_diagonal ? "diagonal" : "axis"),
                      "m/s", speed_mps, expected_mps, Tolerance::kRelative,
                      cells < 6   ? 0.07
                      : cells < 8 ? 0.02
                                  : 0.015,
                      "c^2 = (g/k + sigma k/rho) tanh(k d)"});
      curve.points.emplace_back(2 * pi / k_radpm, speed_mps);
    }
    figure.curves.push_back(std::move(curve));
  }
  rows.push_back({"slowest of these", "m/s", slowest_mps, std::pow(4 * scene.gravity_mps2 * exact.tension_m3ps2, 0.25),
                  Tolerance::kRelative, 0.015, "(4 g sigma / rho)^(1/4), at 1.71 cm"});
  return CaseResult{std::move(rows), {std::move(figure)}};
}

namespace {

/// Speed of the middle of eta^2 over `ticks`: the middle is the phase of its longest wave on the periodic side.
core::Result<double> speedOfMiddle(sim::WaterSim& water, int ticks) {
  const sim::WaveLayout& layout = *water.derived().wave;
  const std::size_t n = layout.count_x;
  double sum_t = 0.0, sum_p = 0.0, sum_tt = 0.0, sum_tp = 0.0;
  double before = 0.0;
  for (int k = 0; k < ticks; ++k) {
    const std::vector<double> eta_m = water.copyState().elevation_m;
    std::complex<double> sum;
    for (std::size_t x = 0; x < n; ++x)
      sum += eta_m[x] * eta_m[x] * std::polar(1.0, 2 * pi * static_cast<double>(x) / static_cast<double>(n));
    const double place = before + std::remainder(std::arg(sum) - before, 2 * pi);
    before = place;
    sum_t += k;
    sum_p += place;
    sum_tt += static_cast<double>(k) * k;
    sum_tp += k * place;
    if (auto done = tick(water); !done) return done.error();
  }
  const double slope = (ticks * sum_tp - sum_t * sum_p) / (ticks * sum_tt - sum_t * sum_t);
  return slope * layout.length_m / (2 * pi * layout.dt_s);
}

}  // namespace

Outcome wavePacket(gpu::Context& ctx, bool quick) {
  struct Choice {
    std::uint32_t resolution_count;
    double depth_cells;
    double wave_cells;
    bool is_quick = false;
  };
  std::vector<Row> rows;
  for (const Choice& each :
       {Choice{128, 3.0, 8, true}, Choice{128, 3.0, 16}, Choice{128, 7.2, 10}, Choice{128, 7.2, 20, true},
        Choice{128, 16.0, 12, true}, Choice{256, 3.0, 40}, Choice{256, 7.2, 40}, Choice{256, 16.0, 24},
        Choice{256, 16.0, 48}, Choice{256, 40.0, 32}, Choice{256, 40.0, 48}}) {
    if (quick && !each.is_quick) continue;
    const core::Scene scene =
        dispersiveScene(each.resolution_count, kCell_m, each.depth_cells * kCell_m, WaveBoundary::kPeriodic);
    auto water = sim::WaterSim::create(ctx, scene);
    if (!water) return water.error();
    const AiryWater exact{scene.gravity_mps2, scene.wave->depth_m};
    const double wavelength_m = each.wave_cells * kCell_m;
    const WavePacket packet(exact, scene.wave->side_m, wavelength_m, 2.0 * wavelength_m);
    setPacket(**water, packet, 0.01, 0.0);
    // As far as two and a half waves, so that the packet hardly spreads.
    const auto ticks = static_cast<int>(2.5 * wavelength_m / packet.groupSpeed_mps() * scene.tick_rate_hz);
    auto speed = speedOfMiddle(**water, ticks);
    if (!speed) return speed.error();
    rows.push_back({fmt::format("{} cells deep: packet of waves of {} cells, kd {:.2f}", each.depth_cells,
                                each.wave_cells, 2 * pi * each.depth_cells / each.wave_cells),
                    "m/s", *speed, packet.groupSpeed_mps(), Tolerance::kRelative, 0.02,
                    "group speed d omega / d k, mean over the packet"});
  }
  return CaseResult{std::move(rows), {}};
}

namespace {

/// Error of the rings of a hump when the first one is eight widths away: root mean square over that of the rings.
core::Result<double> ringError(gpu::Context& ctx, Hump hump, std::uint32_t n) {
  constexpr double kSide_m = 24.0;
  constexpr double kWidth_m = 1.0;
  const core::Scene scene = dispersiveScene(n, kSide_m / n, 1.5, WaveBoundary::kPeriodic);
  auto water = sim::WaterSim::create(ctx, scene);
  if (!water) return water.error();
  const sim::WaveLayout& layout = *(*water)->derived().wave;
  const auto radius = [](double x, double z) { return std::hypot(x - kSide_m / 2, z - kSide_m / 2); };
  setSurface(**water, [&](double x, double z) { return 0.1 * humpAt(hump, radius(x, z) / kWidth_m); });
  const auto steps = static_cast<int>(std::lround(8 * kWidth_m / (layout.speed_mps * layout.dt_s)));
  if (auto done = run(**water, steps); !done) return done.error();
  // setSurface() starts without flow, so the surface was at rest half a step before.
  const AiryRings rings({scene.gravity_mps2, scene.wave->depth_m}, hump, kWidth_m, (steps + 0.5) * layout.dt_s, 17.0);
  const std::vector<double> eta_m = (*water)->copyState().elevation_m;
  double squares = 0.0;
  double reference = 0.0;
  for (std::size_t i = 0; i < eta_m.size(); ++i) {
    const double exact_m = 0.1 * rings.at(radius((static_cast<double>(i % n) + 0.5) * layout.cell_m,
                                                 (static_cast<double>(i / n) + 0.5) * layout.cell_m));
    squares += (eta_m[i] - exact_m) * (eta_m[i] - exact_m);
    reference += exact_m * exact_m;
  }
  return std::sqrt(squares / reference);
}

}  // namespace

Outcome airyRings(gpu::Context& ctx, bool quick) {
  std::vector<Row> rows;
  for (const Hump hump : {Hump::kGaussian, Hump::kRicker}) {
    for (const std::uint32_t n : {64u, 128u, 256u, 512u}) {
      if (quick && (n != 256 || hump != Hump::kGaussian)) continue;
      auto error = ringError(ctx, hump, n);
      if (!error) return error.error();
      rows.push_back({fmt::format("{} hump of {:.1f} cells: error of its rings, {} cells",
                                  hump == Hump::kGaussian ? "Gaussian" : "Ricker", n / 24.0, n),
                      "%", 100 * *error, n == 256 ? 5.0 : 0.0, n == 256 ? Tolerance::kAtMost : Tolerance::kNone, 0.0,
                      "Hankel integral with omega^2 = g k tanh(k d)"});
    }
  }
  return CaseResult{std::move(rows), {}};
}

}  // namespace spindrift::study
