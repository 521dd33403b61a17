// The wave where it meets something: absorbing sides, a rising bed.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include <fmt/format.h>

#include "cases.h"
#include "wave_modes.h"

namespace spindrift::study {
namespace {

using core::Stencil;
using core::WaveBoundary;
using std::numbers::pi;

/// Amplitude that is left of a packet after it has met the absorbing sides at +-x, over what it was.
core::Result<double> reflected(gpu::Context& ctx, int kx_count, int kz_count, double seconds) {
  core::Scene scene = waveScene(192, 24.0, 1.5, 0.5, Stencil::kFivePoint, WaveBoundary::kPeriodic);
  scene.wave->boundary_minus_x = scene.wave->boundary_plus_x = WaveBoundary::kAbsorb;
  scene.wave->sponge_width_m = 4.0;
  auto water = sim::WaterSim::create(ctx, scene);
  if (!water) return water.error();
  const double k = 2 * pi / 24.0;
  setSurface(**water, [&](double x, double z) {
    const double s = (x - 12.0) / 3.0;
    return 0.1 * std::exp(-s * s) * std::cos(k * kx_count * (x - 12.0)) * std::cos(k * kz_count * z);
  });
  for (int i = 0; i < 8; ++i) (*water)->step();
  const double before_j = (*water)->health().wave_energy_j;
  const auto steps = static_cast<int>(seconds * scene.tick_rate_hz);
  for (int i = 0; i < steps; ++i) (*water)->step();
  return std::sqrt((*water)->health().wave_energy_j / before_j);
}

}  // namespace

Outcome reflection(gpu::Context& ctx, bool /*quick*/) {
  auto normal = reflected(ctx, 8, 0, 10.0);
  if (!normal) return normal.error();
  auto oblique = reflected(ctx, 8, 8, 14.0);
  if (!oblique) return oblique.error();
  return CaseResult{std::vector<Row>{{"amplitude sent back, normal incidence, waves of 3 m, sponge of 4 m", "%",
                                      100 * *normal, 1.0, Tolerance::kAtMost, 0.0, "nothing"},
                                     {"amplitude sent back at 45 degrees", "%", 100 * *oblique, 5.0, Tolerance::kAtMost,
                                      0.0, "nothing"}},
                    {}};
}

Outcome greensLaw(gpu::Context& ctx, bool quick) {
  const std::uint32_t n = quick ? 512 : 768;
  core::Scene scene = waveScene(n, 96.0, 2.0, 0.5, Stencil::kFivePoint, WaveBoundary::kPeriodic);
  scene.wave->boundary_minus_x = scene.wave->boundary_plus_x = WaveBoundary::kReflect;
  scene.beaches = {core::Beach{core::Side::kPlusX, 70.0, 0.25}};
  auto made = sim::WaterSim::create(ctx, scene);
  if (!made) return made.error();
  sim::WaterSim& water = **made;
  setSurface(water, [](double x, double) { return 0.2 * std::pow(std::cosh((x - 14.0) / 1.5), -2); });
  // The crest's place and height: the highest cell of a row, refined by a parabola.
  const double cell_m = 96.0 / n;
  const auto crest = [&] {
    const auto eta_m = water.copyState().elevation_m;
    const auto begin = eta_m.begin() + static_cast<std::ptrdiff_t>(n) * (n / 2);
    const auto at = std::max_element(begin + n / 4, begin + n - 1);
    const double a = *(at - 1);
    const double b = *at;
    const double c = *(at + 1);
    return std::pair{(static_cast<double>(at - begin) + 0.5) * cell_m, b + (c - a) * (c - a) / (8 * (2 * b - a - c))};
  };
  const auto depthAt = [](double x_m) { return x_m < 26.0 ? 2.0 : 2.0 + (0.25 - 2.0) * (x_m - 26.0) / 70.0; };
  std::vector<Row> rows;
  double first_m = 0.0;
  double first_depth_m = 0.0;
  // Heights while the crest runs from the foot of the slope to where it is a third as deep.
  for (const double stop_m : {30.0, 50.0, 70.0}) {
    double x_m = 0.0;
    double height_m = 0.0;
    for (int tick = 0; tick < 20'000 && x_m < stop_m; ++tick) {
      water.step();
      std::tie(x_m, height_m) = crest();
    }
    if (first_m == 0.0) {
      first_m = height_m;
      first_depth_m = depthAt(x_m);
      continue;
    }
    rows.push_back({fmt::format("crest at a depth of {:.2f} m over that at {:.2f} m", depthAt(x_m), first_depth_m), "",
                    height_m / first_m, std::pow(depthAt(x_m) / first_depth_m, -0.25), Tolerance::kRelative, 0.05,
                    "Green's law, d^(-1/4)"});
  }
  return CaseResult{std::move(rows), {}};
}

}  // namespace spindrift::study
