// Boats: draught, wake and wave-making resistance.
#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <shared/boats.h>

#include "cases.h"
#include "ticks.h"
#include "wave_modes.h"
#include "wave_resistance.h"

namespace spindrift::study {
namespace {

/// A boat that drives straight on through a periodic basin, its speed and resistance when both are steady.
struct SteadyRun {
  double speed_mps;
  double resistance;  ///< over the boat's weight
};

/// Basin of `cells`^2 cells of 15 cm with damping, in which wakes fade before they come round.
core::Scene towingBasin(std::uint32_t cells, double depth_m, core::Dispersion dispersion) {
  core::Scene scene;
  scene.name = "towing basin";
  scene.wave.emplace();
  scene.wave->resolution_count = cells;
  scene.wave->side_m = 0.15 * cells;
  scene.wave->depth_m = depth_m;
  scene.wave->damping_per_s = 0.5;
  scene.wave->dispersion = dispersion;
  setBoundaries(*scene.wave, core::WaveBoundary::kPeriodic);
  scene.boats.emplace();
  return scene;
}

/// Runs `boat` with a thrust that linear theory says it needs for about `speed_mps`.
core::Result<SteadyRun> steadyRun(gpu::Context& ctx, core::Scene scene, core::Boat boat, double speed_mps,
                                  double expected_resistance) {
  constexpr double kDragPerLength = 0.35;  // bodies/kick.comp
  const double g = scene.gravity_mps2;
  boat.x_m = -scene.wave->side_m / 4;
  boat.throttle_ratio = 1.0;
  boat.max_speed_mps = std::sqrt(speed_mps * speed_mps + expected_resistance * g * boat.length_m / kDragPerLength);
  scene.boats->boats = {boat};
  auto made = sim::WaterSim::create(ctx, scene);
  if (!made) return made.error();
  sim::WaterSim& water = **made;
  sim::StateCopy state = water.copyState();
  state.boats[8] = static_cast<float>(speed_mps);
  water.setState(state);
  if (auto done = runTo(water, 16.0, [] {}); !done) return done.error();
  SteadyRun out{};
  constexpr int kSamples = 40;
  for (int k = 0; k < kSamples; ++k) {
    if (auto done = run(water, 7); !done) return done.error();
    const auto boats = water.copyState().boats;
    out.speed_mps += double{boats[8]} / kSamples;
    out.resistance -= double{boats[27]} / g / kSamples;
  }
  return out;
}

/// Adds a row per speed, given as U/sqrt(g L), and what was measured.
core::Result<void> addResistance(gpu::Context& ctx, double depth_m, core::Dispersion dispersion,
                                 const std::vector<double>& froude_numbers, std::vector<Row>& rows,
                                 std::vector<SteadyRun>& runs) {
  const core::Boat boat{.length_m = 2.4, .beam_m = 0.9, .height_m = 0.6, .density_ratio = 0.25};
  const core::Scene scene = towingBasin(128, depth_m, dispersion);
  const core::WaveScene& wave = *scene.wave;
  const HullPressure hull = hullPressure(boat, wave.side_m / wave.resolution_count);
  const LinearWater water{scene.gravity_mps2, depth_m, dispersion == core::Dispersion::kAiry};
  const double hull_mps = std::sqrt(water.gravity_mps2 * boat.length_m);
  for (const double number : froude_numbers) {
    const double wanted_mps = number * hull_mps;
    const auto steady = steadyRun(ctx, scene, boat, wanted_mps,
                                  basinResistance(hull, water, wanted_mps, wave.side_m, wave.damping_per_s));
    if (!steady) return steady.error();
    runs.push_back(*steady);
    rows.push_back({fmt::format("{} m deep, {}: resistance at U = {:.3f} sqrt(g L), {:.2f} sqrt(g d)", depth_m,
                                water.disperses ? "Airy" : "no dispersion", steady->speed_mps / hull_mps,
                                steady->speed_mps / std::sqrt(water.gravity_mps2 * depth_m)),
                    "of weight", steady->resistance,
                    basinResistance(hull, water, steady->speed_mps, wave.side_m, wave.damping_per_s),
                    Tolerance::kAbsolute, 0.004,
                    fmt::format("linear theory in the same basin; without sides and damping {:.4f}",
                                openWaterResistance(hull, water, steady->speed_mps))});
  }
  return {};
}

}  // namespace

Outcome floatingBody(gpu::Context& ctx, bool quick) {
  std::vector<Row> rows;
  for (const double density_ratio : {0.2, 0.5, 0.8}) {
    core::Scene scene;
    scene.name = "boat";
    scene.wave.emplace();
    scene.wave->resolution_count = 128;
    scene.wave->side_m = 20.0;
    scene.wave->depth_m = 1.5;
    scene.wave->damping_per_s = 1.0;
    setBoundaries(*scene.wave, core::WaveBoundary::kReflect);
    scene.boats.emplace();
    scene.boats->boats = {core::Boat{.length_m = 3.0, .beam_m = 1.2, .height_m = 0.8, .density_ratio = density_ratio}};
    auto water = sim::WaterSim::create(ctx, scene);
    if (!water) return water.error();
    if (auto done = run(**water, quick ? 900 : 1800); !done) return done.error();
    const sim::StateCopy state = (*water)->copyState();
    const double keel_m = state.boats[1] - 0.4;
    // The walls keep the displaced water, so the level away from the hull is a little higher.
    const double level_m = state.elevation_m[5 + 128 * 5];
    rows.push_back({fmt::format("draught of a hull of 0.8 m at density {}", density_ratio), "m", level_m - keel_m,
                    density_ratio * 0.8, Tolerance::kRelative, 0.03, "Archimedes"});
  }
  return CaseResult{std::move(rows), {}};
}

Outcome machWedge(gpu::Context& ctx, bool /*quick*/) {
  core::Scene scene;
  scene.name = "wedge";
  scene.wave.emplace();
  scene.wave->resolution_count = 256;
  scene.wave->side_m = 40.0;
  scene.wave->depth_m = 0.4;
  setBoundaries(*scene.wave, core::WaveBoundary::kReflect);
  scene.boats.emplace();
  scene.boats->boats = {core::Boat{
      .x_m = -15.0, .length_m = 1.5, .beam_m = 0.6, .height_m = 0.3, .max_speed_mps = 5.0, .throttle_ratio = 1.0}};
  auto made = sim::WaterSim::create(ctx, scene);
  if (!made) return made.error();
  sim::WaterSim& water = **made;
  if (auto done = run(water, 360); !done) return done.error();
  const sim::StateCopy state = water.copyState();
  const double x_m = state.boats[0];
  const double forward_mps = state.boats[8];
  const double cell_m = 40.0 / 256;
  // Distance from the track to the highest point of the wake's arm, this far behind the boat.
  const auto arm_m = [&](double behind_m) {
    const auto x = static_cast<std::size_t>((x_m - behind_m + 20.0) / cell_m);
    std::size_t best = 130;
    for (std::size_t z = 130; z < 250; ++z) {
      if (std::abs(state.elevation_m[x + 256 * z]) > std::abs(state.elevation_m[x + 256 * best])) best = z;
    }
    return static_cast<double>(best) * cell_m;
  };
  const double c_mps = water.derived().wave->speed_mps;
  return CaseResult{std::vector<Row>{{fmt::format("half angle of the wedge at {:.2f} c", forward_mps / c_mps), "rad",
                                      std::atan((arm_m(9.0) - arm_m(5.0)) / 4.0), std::asin(c_mps / forward_mps),
                                      Tolerance::kAbsolute, 0.12,
                                      "arcsin(c/U): without dispersion there is no Kelvin wake; tolerance: one cell in "
                                      "each of the two places"}},
                    {}};
}

Outcome boatResistance(gpu::Context& ctx, bool quick) {
  using core::Dispersion;
  std::vector<Row> rows;
  std::vector<SteadyRun> runs;
  if (quick) {
    if (auto done = addResistance(ctx, 2.4, Dispersion::kAiry, {0.55}, rows, runs); !done) return done.error();
    if (auto done = addResistance(ctx, 0.5, Dispersion::kAiry, {0.7}, rows, runs); !done) return done.error();
    return CaseResult{std::move(rows), {}};
  }
  const std::vector<double> slow = {0.25, 0.3, 0.35, 0.4, 0.45, 0.5};
  const std::vector<double> fast = {0.55, 0.6, 0.65, 0.7, 0.8, 0.9, 1.0};
  if (auto done = addResistance(ctx, 2.4, Dispersion::kAiry, slow, rows, runs); !done) return done.error();
  if (auto done = addResistance(ctx, 4.8, Dispersion::kAiry, fast, rows, runs); !done) return done.error();
  const auto hump =
      std::ranges::max_element(runs, {}, [](const SteadyRun& r) { return r.resistance / (r.speed_mps * r.speed_mps); });
  rows.push_back({"hump: largest resistance over U^2 at U/sqrt(g L)", "", hump->speed_mps / std::sqrt(9.81 * 2.4), 0.55,
                  Tolerance::kAbsolute, 0.051, "the same of linear theory, in steps of 0.05"});
  const std::vector<double> shallow = {0.3, 0.4, 0.45, 0.5, 0.6, 0.8};
  if (auto done = addResistance(ctx, 0.5, Dispersion::kAiry, shallow, rows, runs); !done) return done.error();
  if (auto done = addResistance(ctx, 0.5, Dispersion::kNone, {0.6, 0.8}, rows, runs); !done) return done.error();
  return CaseResult{std::move(rows), {}};
}

}  // namespace spindrift::study
