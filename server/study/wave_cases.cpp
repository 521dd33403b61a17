// The wave on a flat bed: dispersion, order, energy, damping.
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "cases.h"
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
  return fitRecurrence(series, true).omega_radps((*water)->derived().wave->dt_s);
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
      // Whole waves on whole cells: 10 cells a wave along the axis, 480 sqrt(1/2)/34 = 9.98 along the diagonal.
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
    (*water)->step();
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
    rows.push_back({fmt::format("decay of a mode at kappa = {} 1/s", kappa), "1/s",
                    fitRecurrence(series, false).decay_per_s((*water)->derived().wave->dt_s), kappa / 2,
                    Tolerance::kRelative, 0.01, "eta_tt + kappa eta_t = c^2 lap eta: kappa/2"});
  }
  return CaseResult{std::move(rows), {}};
}

}  // namespace spindrift::study
