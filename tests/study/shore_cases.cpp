// Nonlinear shallow water beside closed forms: water at rest around islands, dam breaks on dry and wet beds.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "cases.h"
#include "shallow_water.h"
#include "ticks.h"

namespace spindrift::study {
namespace {

constexpr double kUnits = 1 << 24;

/// Mean absolute error of the depth along x over the cells of one row [m].
core::Result<double> damBreakError(gpu::Context& ctx, const DamBreak& exact, std::uint32_t cells, double time_s) {
  const double cell_m = 20.0 / cells;
  core::Scene scene = shallowScene(cells, cell_m, exact.high_m, 0.33);
  auto water = sim::WaterSim::create(ctx, scene);
  if (!water) return water.error();
  setShallowState(**water, [&](double x, double) { return x < 0 ? 0.0 : exact.low_m - exact.high_m; });
  if (auto done = runTo(**water, time_s); !done) return done.error();
  const std::vector<double> eta_m = (*water)->copyState().elevation_m;
  double sum_m = 0.0;
  const std::size_t row = std::size_t{cells} * (cells / 2);
  for (std::size_t x = 0; x < cells; ++x) {
    const double x_m = (static_cast<double>(x) + 0.5) * cell_m - 10.0;
    sum_m += std::abs(eta_m[row + x] + exact.high_m - exact.at(x_m, (*water)->time_s()).depth_m);
  }
  return sum_m / cells;
}

}  // namespace

Outcome damBreakOfShallowWater(gpu::Context& ctx, bool) {
  std::vector<Row> rows;
  for (const auto& [name, low_m, bound_mm, peer] :
       {std::tuple{"dry bed (Ritter)", 0.0, 11.0, "0.021"}, {"wet bed (Stoker)", 0.1, 9.0, "0.0026"}}) {
    const DamBreak exact{9.81, 1.0, low_m};
    const auto error_m = damBreakError(ctx, exact, 200, 1.0);
    if (!error_m) return error_m.error();
    rows.push_back({fmt::format("dam break on a {}, 200 cells: mean error of the depth", name), "mm", *error_m * 1e3,
                    bound_mm, Tolerance::kAtMost, 0.0, fmt::format("closed form; REEF3D-SFLOW L1 {}", peer)});
  }
  return CaseResult{std::move(rows), {}};
}

Outcome lakeWithIslands(gpu::Context& ctx, bool quick) {
  const int ticks = quick ? 1000 : 10000;
  std::vector<Row> rows;
  for (const bool disperses : {false, true}) {
    core::Scene scene = shallowScene(96, 1.0 / 3, 2.0, 0.4);
    scene.beaches = {core::Beach{core::Side::kPlusX, 20.0, -1.0}};
    scene.obstacles = {core::Rock{.x_m = -8, .z_m = 6, .radius_m = 2.0, .height_m = 0.5},
                       core::Breakwater{.x_m = -5, .z_m = 0, .length_m = 40, .width_m = 1.0, .heading_deg = 90.0},
                       core::Breakwater{.x_m = 3, .z_m = 0, .length_m = 40, .width_m = 1.0, .heading_deg = 90.0}};
    // An island, and a pit in its top.
    constexpr double kIslandX_m = -11.0, kIslandZ_m = -8.0, kRim_m = 1.5;
    scene.bed.emplace().shapes = {
        core::BedCone{
            .x_m = kIslandX_m, .z_m = kIslandZ_m, .toe_radius_m = 4.0, .crest_radius_m = 2.2, .height_m = 2.6},
        core::BedCone{
            .x_m = kIslandX_m, .z_m = kIslandZ_m, .toe_radius_m = kRim_m, .crest_radius_m = 0.8, .height_m = -0.4}};
    if (disperses) scene.wave->dispersion = core::Dispersion::kAiry;
    auto water = sim::WaterSim::create(ctx, scene);
    if (!water) return water.error();
    // Ponds at other levels than the still water: between the walls and in the pit.
    setShallowState(**water, [&](double x, double z) {
      if (std::hypot(x - kIslandX_m, z - kIslandZ_m) < kRim_m) return 0.4;
      return x < -5.0 ? 0.21 : x < 3.0 ? 0.06 : -0.13;
    });
    const std::vector<double> before_m = (*water)->copyState().elevation_m;
    if (auto done = run(**water, ticks); !done) return done.error();
    const std::vector<double> after_m = (*water)->copyState().elevation_m;
    double largest = 0.0;
    for (std::size_t i = 0; i < after_m.size(); ++i) largest = std::max(largest, std::abs(after_m[i] - before_m[i]));
    rows.push_back({fmt::format("ponds at four levels, with island, beach, rock and walls{}, {} steps: largest change",
                                disperses ? ", with dispersion" : "", ticks),
                    "units", largest * kUnits, 0.0, Tolerance::kAtMost, 0.0,
                    "water at rest stays at rest; a unit is 2^-24 m"});
  }
  return CaseResult{std::move(rows), {}};
}

}  // namespace spindrift::study
