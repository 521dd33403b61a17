// Waves that disperse, between walls: modes, thin walls, level water, energy.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

#include <fmt/format.h>

#include "basin_modes.h"
#include "cases.h"
#include "ticks.h"
#include "wave_modes.h"

namespace spindrift::study {
namespace {

using core::WaveBoundary;
constexpr double kThin = 0.9;  ///< width of a wall of one cell, in cells

/// A straight wall, one cell thick, over the cells from (x0, z0) to (x1, z1), which have a row or a column in common.
core::Breakwater thinWall(const core::WaveScene& wave, int x0, int z0, int x1, int z1) {
  const double cell_m = wave.side_m / wave.resolution_count;
  const double half_m = wave.side_m / 2;
  return {.x_m = 0.5 * (x0 + x1 + 1) * cell_m - half_m,
          .z_m = 0.5 * (z0 + z1 + 1) * cell_m - half_m,
          .length_m = (std::max(std::abs(x1 - x0), std::abs(z1 - z0)) + kThin) * cell_m,
          .width_m = kThin * cell_m,
          .heading_deg = x0 == x1 ? 90.0 : 0.0};
}

}  // namespace

Outcome basinModes(gpu::Context& ctx, bool quick) {
  struct Water {
    double depth_m, cell_m, most_percent;
  };
  std::vector<Row> rows;
  for (const Water& each : {Water{1.2, 1.0 / 6, 1.0}, Water{4.0, 0.1, 4.0}}) {
    core::Scene scene = dispersiveScene(96, each.cell_m, each.depth_m, WaveBoundary::kReflect);
    scene.obstacles = {thinWall(*scene.wave, 48, 30, 48, 69), thinWall(*scene.wave, 48, 69, 79, 69)};
    auto water = sim::WaterSim::create(ctx, scene);
    if (!water) return water.error();
    const sim::WaveLayout& layout = *(*water)->derived().wave;
    const auto modes = lowestModes(layout, sim::layOutBasin(scene, layout), quick ? 6 : 40);
    for (const std::size_t number : {1u, 2u, 4u, 5u, 12u, 25u, 39u}) {
      if (number >= modes.size()) continue;
      const BasinMode& mode = modes[number - 1];
      const auto shape = [&](double x_m, double z_m) {
        return mode
            .shape[static_cast<std::size_t>(x_m / layout.cell_m) + 96 * static_cast<std::size_t>(z_m / layout.cell_m)];
      };
      setSurface(**water, [&](double x, double z) { return 0.01 * shape(x, z); });
      const auto series = amplitudes(**water, shape, 60);
      if (!series) return series.error();
      const double kd = mode.k_radpm * each.depth_m;
      const double expected = std::sqrt(scene.gravity_mps2 * mode.k_radpm * std::tanh(kd));
      const double omega = fitRecurrence(*series, true).omega_radps(layout.dt_s);
      rows.push_back(
          {fmt::format("L-shaped wall, water {} m deep: frequency of mode {}, kd {:.2f}", each.depth_m, number, kd),
           "rad/s", omega, expected, Tolerance::kRelative, 0.01 * each.most_percent,
           "omega^2 = g k tanh(k d), k from the Laplacian of the grid"});
    }
  }
  return CaseResult{std::move(rows), {}};
}

namespace {

/// Harbor-like water without losses: breakwaters, rocks, thin walls, a beach that stays wet.
core::Scene harborScene(std::uint32_t n, double tick_rate_hz) {
  core::Scene scene = dispersiveScene(n, 32.0 / n, 1.2, WaveBoundary::kReflect, tick_rate_hz);
  scene.obstacles = {core::Breakwater{.x_m = -6, .z_m = -4, .length_m = 14, .width_m = 1.2, .heading_deg = 60},
                     core::Breakwater{.x_m = 6, .z_m = -11, .length_m = 9, .width_m = 1.2, .heading_deg = 0},
                     core::Rock{.x_m = -8, .z_m = 6, .radius_m = 1.3},
                     core::Rock{.x_m = -6.3, .z_m = 7.6, .radius_m = 0.8},
                     core::Rock{.x_m = 2.5, .z_m = 10.5, .radius_m = 1.1}};
  const int cells = static_cast<int>(n);
  scene.obstacles.emplace_back(thinWall(*scene.wave, cells / 4, cells / 8, cells / 2, cells / 8));
  scene.beaches = {core::Beach{.side = core::Side::kPlusX, .width_m = 7, .shore_depth_m = 0.12}};
  return scene;
}

/// Largest change of the elevation of a cell [units] after `ticks`, from levels without flow.
core::Result<double> largestChange(gpu::Context& ctx, const core::Scene& scene, int ticks,
                                   const std::function<double(double, double)>& level_m) {
  auto water = sim::WaterSim::create(ctx, scene);
  if (!water) return water.error();
  const sim::Basin basin = sim::layOutBasin(scene, *(*water)->derived().wave);
  setSurface(**water, level_m);
  sim::StateCopy state = (*water)->copyState();
  for (std::size_t i = 0; i < basin.depth_m.size(); ++i) {
    if (basin.depth_m[i] <= 0) state.elevation_m[i] = 0.0;
  }
  (*water)->setState(state);
  const std::vector<double> before_m = (*water)->copyState().elevation_m;
  if (auto done = run(**water, ticks); !done) return done.error();
  const std::vector<double> after_m = (*water)->copyState().elevation_m;
  double largest_m = 0.0;
  for (std::size_t i = 0; i < after_m.size(); ++i) largest_m = std::max(largest_m, std::abs(after_m[i] - before_m[i]));
  return largest_m * double{1 << 24};
}

}  // namespace

Outcome dispersedStillWater(gpu::Context& ctx, bool quick) {
  const int ticks = quick ? 200 : 1200;
  std::vector<Row> rows;
  const auto add = [&](const std::string& name, core::Result<double> units) -> core::Result<void> {
    if (!units) return units.error();
    rows.push_back({fmt::format("{}, {} steps: largest change", name, ticks), "units", *units, 0.0, Tolerance::kAtMost,
                    0.0, "level water stays level; a unit is 2^-24 m"});
    return {};
  };
  const core::Scene harbor = harborScene(96, 60.0);
  for (const double level_m : {0.0, 0.05}) {
    if (auto done = add(fmt::format("rocks, walls and a beach, level {} m", level_m),
                        largestChange(ctx, harbor, ticks, [=](double, double) { return level_m; }));
        !done)
      return done.error();
  }
  core::Scene two = dispersiveScene(96, 1.0 / 6, 1.2, WaveBoundary::kReflect);
  two.obstacles = {thinWall(*two.wave, 48, 0, 48, 95)};
  if (auto done = add("two basins, one 5 cm higher",
                      largestChange(ctx, two, ticks, [](double x, double) { return x > 8.1 ? 0.05 : 0.0; }));
      !done)
    return done.error();
  return CaseResult{std::move(rows), {}};
}

Outcome thinWalls(gpu::Context& ctx, bool quick) {
  const double seconds = quick ? 3.0 : 30.0;
  std::vector<Row> rows;
  for (const auto& [depth_m, cell_m] : {std::pair{1.2, 1.0 / 6}, std::pair{4.0, 0.1}}) {
    for (const bool is_diagonal : {false, true}) {
      core::Scene scene = dispersiveScene(96, cell_m, depth_m, WaveBoundary::kReflect);
      const double side_m = scene.wave->side_m;
      // An odd column, so that a block of the coarser grids lies on both sides of the wall.
      core::Breakwater wall = thinWall(*scene.wave, 49, 0, 49, 95);
      if (is_diagonal) wall = {.length_m = 2 * side_m, .width_m = kThin * cell_m, .heading_deg = 45.0};
      scene.obstacles = {wall};
      auto water = sim::WaterSim::create(ctx, scene);
      if (!water) return water.error();
      setSurface(**water, [&](double x, double z) {
        return 0.1 *
               std::exp(-(std::pow(x - 0.25 * side_m, 2) + std::pow(z - 0.7 * side_m, 2)) / std::pow(0.06 * side_m, 2));
      });
      const auto isBehind = [&](std::size_t i) { return is_diagonal ? i % 96 > i / 96 : i % 96 > 49; };
      const sim::Basin basin = sim::layOutBasin(scene, *(*water)->derived().wave);
      sim::StateCopy state = (*water)->copyState();
      for (std::size_t i = 0; i < state.elevation_m.size(); ++i) {
        if (isBehind(i) || basin.depth_m[i] <= 0) state.elevation_m[i] = 0.0;
      }
      (*water)->setState(state);
      double behind_m = 0.0;
      double before_m = 0.0;
      for (int part = 0; part < 6; ++part) {
        if (auto done = run(**water, static_cast<int>(seconds * 10)); !done) return done.error();
        state = (*water)->copyState();
        before_m = 0.0;
        for (std::size_t i = 0; i < state.elevation_m.size(); ++i) {
          double& largest_m = isBehind(i) ? behind_m : before_m;
          largest_m = std::max(largest_m, std::abs(state.elevation_m[i]));
        }
      }
      rows.push_back({fmt::format("{} wall of one cell, water {} cells deep, {} s: largest elevation behind ({:.0f} mm "
                                  "before it)",
                                  is_diagonal ? "diagonal" : "straight", std::round(10 * depth_m / cell_m) / 10,
                                  seconds, 1000 * before_m),
                      "units", behind_m * double{1 << 24}, 0.0, Tolerance::kAtMost, 0.0, "nothing passes a wall"});
    }
  }
  return CaseResult{std::move(rows), {}};
}

Outcome dispersedEnergy(gpu::Context& ctx, bool quick) {
  std::vector<Row> rows;
  for (const double steepening : {0.0, 0.4}) {
    core::Scene scene = harborScene(quick ? 96 : 192, 60.0);
    scene.wave->steepening_ratio = steepening;
    auto made = sim::WaterSim::create(ctx, scene);
    if (!made) return made.error();
    sim::WaterSim& water = **made;
    const sim::Basin basin = sim::layOutBasin(scene, *water.derived().wave);
    std::mt19937 random(3);
    std::normal_distribution<double> level_m(0.0, 0.02);
    sim::StateCopy state = water.copyState();
    for (std::size_t i = 0; i < basin.depth_m.size(); ++i)
      state.elevation_m[i] = basin.depth_m[i] > 0 ? level_m(random) : 0.0;
    water.setState(state);
    // The leapfrog eta'' - 2 eta' + eta = -dt^2 S eta' with a symmetric S conserves |eta'|^2 - <eta'', eta>: up to a
    // factor the energy |eta'' - eta'|^2/dt^2 + <eta'', S eta'> (docs/dispersion.md). No inverse of F is needed.
    const auto energy = [&]() -> core::Result<double> {
      const std::vector<double> first = water.copyState().elevation_m;
      if (auto done = tick(water); !done) return done.error();
      const std::vector<double> second = water.copyState().elevation_m;
      if (auto done = tick(water); !done) return done.error();
      const std::vector<double> third = water.copyState().elevation_m;
      double sum = 0.0;
      for (std::size_t i = 0; i < first.size(); ++i) sum += second[i] * second[i] - third[i] * first[i];
      return sum;
    };
    auto first = energy();
    if (!first) return first.error();
    const int steps = quick ? 300 : 20'000;
    constexpr int kParts = 10;
    double drift = 0.0;
    for (int part = 0; part < kParts; ++part) {
      if (auto done = run(water, steps / kParts - 2); !done) return done.error();
      auto now = energy();
      if (!now) return now.error();
      drift = std::max(drift, std::abs(*now / *first - 1));
    }
    rows.push_back({fmt::format("random 2 cm in a harbor, {}, {} steps: energy, largest |E/E0 - 1|",
                                steepening > 0 ? "steepening 0.4" : "linear", steps),
                    "", drift, steepening > 0 ? 2e-3 : 1e-4, Tolerance::kAtMost, 0.0, "conserved: F is symmetric"});
  }
  return CaseResult{std::move(rows), {}};
}

}  // namespace spindrift::study
