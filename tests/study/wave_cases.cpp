// The wave on a flat bed: dispersion, order, energy, damping.
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "cases.h"
#include "ticks.h"
#include "wave_modes.h"

namespace spindrift::study {
namespace {

using core::Stencil;
using core::WaveBoundary;
using std::numbers::pi;

const char* nameOf(Stencil stencil) {
  return stencil == Stencil::kNinePoint ? "9-point" : "5-point";
}

/// Frequency of cos(kx x) cos(kz z) on a square of n x n cells, from `steps` steps.
core::Result<double> frequency(gpu::Context& ctx, const core::Scene& scene, double kx, double kz, int steps) {
  auto water = sim::WaterSim::create(ctx, scene);
  if (!water) return water.error();
  const auto mode = [&](double x, double z) { return std::cos(kx * x) * std::cos(kz * z); };
  setSurface(**water, [&](double x, double z) { return 0.1 * mode(x, z); });
  const auto series = amplitudes(**water, mode, steps);
  if (!series) return series.error();
  return fitRecurrence(*series, true).omega_radps((*water)->derived().wave->dt_s);
}

}  // namespace

Outcome eigenmode(gpu::Context& ctx, bool quick) {
  const core::Scene scene = waveScene(64, 12.0, 1.5, 0.6, Stencil::kFivePoint, WaveBoundary::kReflect);
  const double cell_m = 12.0 / 64;
  const double dt_s = 1.0 / scene.tick_rate_hz;
  std::vector<Row> rows;
  for (const auto& [p, q] : {std::pair{3, 2}, std::pair{8, 0}, std::pair{10, 10}}) {
    const double kx = p * pi / 12.0;
    const double kz = q * pi / 12.0;
    auto omega = frequency(ctx, scene, kx, kz, quick ? 200 : 2000);
    if (!omega) return omega.error();
    const double s = std::hypot(std::sin(kx * cell_m / 2), std::sin(kz * cell_m / 2));
    rows.push_back({fmt::format("frequency of mode ({}, {}), 64 cells, S = 0.6", p, q), "rad/s", *omega,
                    2 / dt_s * std::asin(0.6 * s), Tolerance::kRelative, 1e-5,
                    "discrete dispersion: sin^2(w dt/2) = S^2 (sin^2(kx dx/2) + sin^2(kz dx/2))"});
  }
  return CaseResult{std::move(rows), {}};
}

Outcome observedOrder(gpu::Context& ctx, bool quick) {
  const double k = 2 * pi / 12.0;
  const double exact = std::sqrt(9.81 * 1.5) * std::hypot(2 * k, k);
  std::vector<Row> rows;
  Figure figure{.name = "observed-order",
                .title = "Error of a wave's frequency",
                .x_label = "cells a side [-]",
                .y_label = "relative error [-]",
                .is_logarithmic = true,
                .curves = {}};
  for (const Stencil stencil : {Stencil::kFivePoint, Stencil::kNinePoint}) {
    Figure::Curve curve{nameOf(stencil), {}};
    double coarser = 0.0;
    for (const std::uint32_t n : {32u, 64u, 128u}) {
      core::Scene scene = waveScene(n, 12.0, 1.5, 0.5, stencil, WaveBoundary::kPeriodic);
      scene.gravity_mps2 = 9.81;
      scene.tick_rate_hz = std::sqrt(9.81 * 1.5) / (0.5 * 12.0 / n);
      auto omega = frequency(ctx, scene, 2 * k, k, static_cast<int>(n) * (quick ? 4 : 16));
      if (!omega) return omega.error();
      const double error = std::abs(*omega / exact - 1);
      rows.push_back({fmt::format("{}: frequency error at {} cells", nameOf(stencil), n), "", error, 0.0,
                      Tolerance::kNone, 0.0, "sqrt(g d) |k|"});
      if (coarser > 0) {
        rows.push_back({fmt::format("{}: observed order {} to {} cells", nameOf(stencil), n / 2, n), "",
                        std::log2(coarser / error), 2.0, Tolerance::kAbsolute, 0.1, "second order in dx and dt"});
      }
      curve.points.emplace_back(n, error);
      coarser = error;
    }
    figure.curves.push_back(std::move(curve));
  }
  Figure::Curve second_order{"second order", {}};
  const auto [first_n, first_error] = figure.curves.front().points.front();
  for (const auto& [n, error] : figure.curves.front().points)
    second_order.points.emplace_back(n, first_error * std::pow(first_n / n, 2));
  figure.curves.push_back(std::move(second_order));
  return CaseResult{std::move(rows), {std::move(figure)}};
}

Outcome phaseError(gpu::Context& ctx, bool quick) {
  std::vector<Row> rows;
  for (const Stencil stencil : {Stencil::kFivePoint, Stencil::kNinePoint}) {
    for (const bool diagonal : {false, true}) {
      // Whole waves on whole cells: 10 cells per wave along the axis, 480 sqrt(1/2)/34 = 9.98 along the diagonal.
      const std::uint32_t n = diagonal ? 480 : 160;
      const int waves = diagonal ? 34 : 16;
      const double k = 2 * pi * waves / 12.0;
      const core::Scene scene = waveScene(n, 12.0, 1.5, 0.5, stencil, WaveBoundary::kPeriodic);
      auto omega = frequency(ctx, scene, k, diagonal ? k : 0.0, quick ? 40 : 200);
      if (!omega) return omega.error();
      const double exact = std::sqrt(scene.gravity_mps2 * 1.5) * k * (diagonal ? std::numbers::sqrt2 : 1.0);
      const double expected_percent = !diagonal ? -1.24 : stencil == Stencil::kFivePoint ? -0.42 : -1.23;
      rows.push_back({fmt::format("{}: phase error {}, 10 cells a wave, S = 0.5", nameOf(stencil),
                                  diagonal ? "along the diagonal" : "along the axis"),
                      "%", 100 * (*omega / exact - 1), expected_percent, Tolerance::kAbsolute, 0.02,
                      "expansion of the discrete dispersion"});
    }
  }
  return CaseResult{std::move(rows), {}};
}

namespace {

/// Rings of the hump exp(-(r/w)^2) at rest at t = 0: eta(r, t) = w^2/2 Int k exp(-(k w/2)^2) J0(k r) cos(c k t) dk.
class HumpRings {
 public:
  HumpRings(double width_m, double travelled_m, double reach_m) : step_m_(width_m / 40) {
    const auto count = static_cast<std::size_t>(std::ceil(reach_m / step_m_)) + 2;
    eta_.reserve(count);
    for (std::size_t k_r = 0; k_r < count; ++k_r) {
      const double r_m = static_cast<double>(k_r) * step_m_;
      double sum = 0.0;
      constexpr int kPoints = 600;
      const double dk = 12.0 / width_m / kPoints;
      for (int i = 1; i <= kPoints; ++i) {
        const double k = i * dk;
        sum +=
            k * std::exp(-k * k * width_m * width_m / 4) * std::cyl_bessel_j(0.0, k * r_m) * std::cos(k * travelled_m);
      }
      eta_.push_back(0.5 * width_m * width_m * sum * dk);
    }
  }
  [[nodiscard]] double at(double r_m) const {
    const double u = r_m / step_m_;
    const auto i = static_cast<std::size_t>(u);
    return std::lerp(eta_[i], eta_[i + 1], u - static_cast<double>(i));
  }

 private:
  double step_m_;
  std::vector<double> eta_;
};

/// Error of the rings of a hump four cells wide after they have travelled five widths: root mean square over that of
/// the rings.
core::Result<double> humpError(gpu::Context& ctx, Stencil stencil, double courant) {
  const double width_m = 1.0;
  const core::Scene scene = waveScene(96, 24.0, 1.5, courant, stencil, WaveBoundary::kPeriodic);
  auto water = sim::WaterSim::create(ctx, scene);
  if (!water) return water.error();
  const sim::WaveLayout& layout = *(*water)->derived().wave;
  const auto radius = [](double x, double z) { return std::hypot(x - 12.0, z - 12.0); };
  setSurface(**water, [&](double x, double z) { return 0.1 * std::exp(-std::pow(radius(x, z) / width_m, 2)); });
  const double c_mps = layout.speed_mps;
  const auto steps = static_cast<int>(std::lround(5 * width_m / (c_mps * layout.dt_s)));
  if (auto done = run(**water, steps); !done) return done.error();
  // setSurface() starts without flow, so the surface was at rest half a step before.
  const HumpRings rings(width_m, c_mps * (steps + 0.5) * layout.dt_s, 17.0);
  const std::vector<double> eta_m = (*water)->copyState().elevation_m;
  double squares = 0.0;
  double reference = 0.0;
  for (std::size_t i = 0; i < eta_m.size(); ++i) {
    const std::size_t row = i / 96;
    const double exact_m =
        0.1 * rings.at(radius((static_cast<double>(i % 96) + 0.5) * 0.25, (static_cast<double>(row) + 0.5) * 0.25));
    squares += (eta_m[i] - exact_m) * (eta_m[i] - exact_m);
    reference += exact_m * exact_m;
  }
  return std::sqrt(squares / reference);
}

}  // namespace

Outcome roundHump(gpu::Context& ctx, bool /*quick*/) {
  std::vector<Row> rows;
  const std::string source = "closed form (Hankel transform of the hump)";
  for (const double courant : {0.35, 0.5, 0.69, 0.84}) {
    double five = 0.0;
    for (const Stencil stencil : {Stencil::kFivePoint, Stencil::kNinePoint}) {
      if (stencil == Stencil::kFivePoint && courant > 0.7) continue;  // beyond its stability limit
      auto error = humpError(ctx, stencil, courant);
      if (!error) return error.error();
      rows.push_back({fmt::format("{}: error of the rings, S = {}", nameOf(stencil), courant), "%", 100 * *error, 0.0,
                      Tolerance::kNone, 0.0, source});
      if (stencil == Stencil::kFivePoint) five = *error;
      if (stencil == Stencil::kNinePoint && five > 0) {
        rows.push_back({fmt::format("9-point over 5-point, S = {}", courant), "", *error / five, 1.1,
                        Tolerance::kAtLeast, 0.0, "why the levels of fidelity choose the 5-point stencil"});
      }
    }
  }
  return CaseResult{std::move(rows), {}};
}

Outcome waveEnergy(gpu::Context& ctx, bool quick) {
  const core::Scene scene = waveScene(32, 12.0, 1.5, 0.6, Stencil::kFivePoint, WaveBoundary::kReflect);
  auto water = sim::WaterSim::create(ctx, scene);
  if (!water) return water.error();
  setSurface(**water, [](double x, double z) { return 0.4 * std::exp(-((x - 5) * (x - 5) + (z - 7) * (z - 7))); });
  const int steps = quick ? 10'000 : 100'000;
  double low = 1e300;
  double high = 0.0;
  double first = 0.0;
  for (int step = 0; step < steps; ++step) {
    if (auto done = tick(**water); !done) return done.error();
    const double energy_j = (*water)->health().wave_energy_j;
    if (step < 10 || energy_j == 0) continue;
    if (first == 0) first = energy_j;
    low = std::min(low, energy_j);
    high = std::max(high, energy_j);
  }
  const std::string name = fmt::format("undamped, reflecting, {} steps: ", steps);
  return CaseResult{std::vector<Row>{{name + "largest energy over the first, less one", "%", 100 * (high / first - 1),
                                      0.1, Tolerance::kAtMost, 0.0, "conserved by the leapfrog"},
                                     {name + "loss to the lowest", "%", 100 * (1 - low / first), 0.1,
                                      Tolerance::kAtMost, 0.0, "conserved by the leapfrog"}},
                    {}};
}

Outcome dampedMode(gpu::Context& ctx, bool quick) {
  std::vector<Row> rows;
  for (const double kappa : {0.2, 1.0}) {
    core::Scene scene = waveScene(64, 12.0, 1.5, 0.5, Stencil::kFivePoint, WaveBoundary::kPeriodic);
    scene.wave->damping_per_s = kappa;
    auto water = sim::WaterSim::create(ctx, scene);
    if (!water) return water.error();
    const double k = 2 * pi * 2 / 12.0;
    const auto mode = [&](double x, double) { return std::cos(k * x); };
    setSurface(**water, [&](double x, double z) { return 0.1 * mode(x, z); });
    const auto series = amplitudes(**water, mode, quick ? 150 : 400);
    if (!series) return series.error();
    rows.push_back({fmt::format("decay of a mode at kappa = {} 1/s", kappa), "1/s",
                    fitRecurrence(*series, false).decayRate_ps((*water)->derived().wave->dt_s), kappa / 2,
                    Tolerance::kRelative, 0.01, "eta_tt + kappa eta_t = c^2 lap eta: kappa/2"});
  }
  return CaseResult{std::move(rows), {}};
}

}  // namespace spindrift::study
