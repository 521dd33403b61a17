// Floaters: draught, heave, roll, loll, terminal velocity and a heap that comes to rest.
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <spindrift/study/floater_pose.h>

#include "cases.h"
#include "ticks.h"

namespace spindrift::study {
namespace {

using core::Floater;
using core::FloaterKind;

constexpr double kGravity_mps2 = 9.81;
constexpr double kAddedMass = 0.5;  ///< of the displaced mass: bodies/floater_water.comp
constexpr double kTick_s = 1.0 / 60.0;
constexpr double kCrateBallast = -0.35;  ///< of a crate, over half its height: floater kinds in server/sim/floaters.cpp
constexpr double kDensity = 0.4;         ///< of a crate
constexpr double kCrate_m = 0.8;

/// Open water in which the waves of a floater leave and do not come back.
core::Scene openWater(std::vector<Floater> floaters) {
  core::Scene scene;
  scene.name = "floaters";
  scene.wave.emplace();
  scene.wave->resolution_count = 128;
  scene.wave->side_m = 40.0;
  scene.wave->depth_m = 2.0;
  scene.wave->damping_per_s = 0.5;
  setBoundaries(*scene.wave, core::WaveBoundary::kAbsorb);
  scene.wave->sponge_width_m = 8.0;
  scene.floaters.emplace();
  scene.floaters->capacity_count = 128;
  scene.floaters->floaters = std::move(floaters);
  return scene;
}

FloaterPose firstPose(sim::WaterSim& water) {
  return floaterPoses(water.copyState()).at(0);
}

/// Lifts the first floater, and tilts it about x.
void disturb(sim::WaterSim& water, double up_m, double tilt_deg) {
  sim::StateCopy state = water.copyState();
  const double half_rad = tilt_deg * std::numbers::pi / 360;
  state.floaters[1] += static_cast<float>(up_m);
  state.floaters[4] = static_cast<float>(std::sin(half_rad));
  state.floaters[5] = state.floaters[6] = 0;
  state.floaters[7] = static_cast<float>(std::cos(half_rad));
  water.setState(state);
}

/// Time between rises through the mean; 0 with fewer than two. [s]
double periodOf(const std::vector<double>& values) {
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  std::vector<double> rises_s;
  for (std::size_t i = 1; i < values.size(); ++i) {
    if (values[i - 1] >= mean || values[i] < mean) continue;
    rises_s.push_back(kTick_s * (static_cast<double>(i) - (values[i] - mean) / (values[i] - values[i - 1])));
  }
  return rises_s.size() < 2 ? 0.0 : (rises_s.back() - rises_s.front()) / static_cast<double>(rises_s.size() - 1);
}

/// Period of `quantity` of a floater that is disturbed after 6 s. [s]
template <typename Quantity>
core::Result<double> periodAfter(gpu::Context& ctx, const Floater& floater, double up_m, double tilt_deg,
                                 Quantity quantity) {
  auto water = sim::WaterSim::create(ctx, openWater({floater}));
  if (!water) return water.error();
  if (auto done = run(**water, 360); !done) return done.error();
  disturb(**water, up_m, tilt_deg);
  std::vector<double> values;
  const auto note = [&] { values.push_back(quantity(firstPose(**water))); };
  if (auto done = run(**water, 240, note); !done) return done.error();
  return periodOf(values);
}

}  // namespace

Outcome floatingObjects(gpu::Context& ctx, bool /*quick*/) {
  struct Body {
    const char* name;
    FloaterKind kind;
    double density_ratio, height_m, draught_m;
  };
  // A cylinder and a ball half under water; the cap of a cylinder, and of a ball: 3 h^2 - 2 h^3 = density, h over the
  // diameter.
  std::vector<Row> rows;
  for (const Body& body : {Body{"crate", FloaterKind::kCrate, 0.3, 0.8, 0.24},
                           {"crate", FloaterKind::kCrate, 0.6, 0.8, 0.48},
                           {"raft", FloaterKind::kRaft, 0.5, 0.096, 0.048},
                           {"standing cylinder", FloaterKind::kBuoy, 0.4, 0.8, 0.32},
                           {"lying cylinder", FloaterKind::kBarrel, 0.5, 0.528, 0.264},
                           {"lying cylinder", FloaterKind::kBarrel, 0.2523, 0.528, 0.528 * 0.3},
                           {"ball", FloaterKind::kBall, 0.1, 0.8, 0.8 * 0.1958}}) {
    auto water = sim::WaterSim::create(
        ctx,
        openWater({Floater{.kind = body.kind, .y_m = 0.0, .size_m = kCrate_m, .density_ratio = body.density_ratio}}));
    if (!water) return water.error();
    if (auto done = run(**water, 720); !done) return done.error();
    rows.push_back({fmt::format("draught of a {} at density {:.2f}", body.name, body.density_ratio), "m",
                    body.height_m / 2 - firstPose(**water).middle_m(), body.draught_m, Tolerance::kRelative, 0.05,
                    "Archimedes"});
  }
  return CaseResult{std::move(rows), {}};
}

Outcome floaterMotion(gpu::Context& ctx, bool /*quick*/) {
  std::vector<Row> rows;
  const auto heave = [](const FloaterPose& pose) { return pose.y_m; };
  for (const auto& [name, kind, density_ratio] :
       {std::tuple{"crate", FloaterKind::kCrate, kDensity}, {"standing cylinder", FloaterKind::kBuoy, 0.45}}) {
    const auto period_s = periodAfter(ctx, {.kind = kind, .y_m = 0.08, .size_m = kCrate_m}, 0.08, 0.0, heave);
    if (!period_s) return period_s.error();
    rows.push_back({fmt::format("period of heave of a {}", name), "s", *period_s,
                    2 * std::numbers::pi * std::sqrt((1 + kAddedMass) * density_ratio * kCrate_m / kGravity_mps2),
                    Tolerance::kRelative, 0.05, "2 pi sqrt(1.5 draught / g): half of the displaced water moves along"});
  }

  struct Box {
    const char* name;
    FloaterKind kind;
    double size_m, density_ratio, height_m, beam_m, ballast_ratio, own_ballast_ratio;
  };
  const auto roll = [](const FloaterPose& pose) { return pose.up_z; };
  for (const Box& box : {Box{"crate", FloaterKind::kCrate, kCrate_m, kDensity, 0.8, 0.8, -0.65, kCrateBallast},
                         {"raft", FloaterKind::kRaft, 2.0, 0.45, 0.24, 1.4, 0.0, 0.0}}) {
    const auto period_s = periodAfter(ctx,
                                      {.kind = box.kind,
                                       .y_m = 0.0,
                                       .size_m = box.size_m,
                                       .density_ratio = box.density_ratio,
                                       .ballast_ratio = box.ballast_ratio - box.own_ballast_ratio},
                                      0.0, 4.0, roll);
    if (!period_s) return period_s.error();
    const double draught_m = box.density_ratio * box.height_m;
    const double metacentric_m =
        draught_m / 2 + box.beam_m * box.beam_m / 12 / draught_m - (1 + box.ballast_ratio) * box.height_m / 2;
    const double inertia_m2 = (box.beam_m * box.beam_m + box.height_m * box.height_m) / 12;
    rows.push_back({fmt::format("period of roll of a {}", box.name), "s", *period_s,
                    2 * std::numbers::pi * std::sqrt((1 + kAddedMass) * inertia_m2 / kGravity_mps2 / metacentric_m),
                    Tolerance::kRelative, 0.05, "2 pi sqrt(1.5 k^2 / (g GM)): metacentric height"});
  }

  // A box whose sides stay wet.
  const double ballast_ratio = 0.28;
  const double draught_m = kDensity * kCrate_m;
  const double moment_m = kCrate_m * kCrate_m / 12 / draught_m;
  const double metacentric_m = draught_m / 2 + moment_m - (1 + kCrateBallast + ballast_ratio) * kCrate_m / 2;
  auto water =
      sim::WaterSim::create(ctx, openWater({Floater{.y_m = 0.0, .size_m = kCrate_m, .ballast_ratio = ballast_ratio}}));
  if (!water) return water.error();
  if (auto done = run(**water, 180); !done) return done.error();
  disturb(**water, 0.0, 3.0);
  if (auto done = run(**water, 1800); !done) return done.error();
  rows.push_back({"angle of loll of a top-heavy crate", "deg", firstPose(**water).tilt_deg(),
                  std::atan(std::sqrt(-2 * metacentric_m / moment_m)) * 180 / std::numbers::pi, Tolerance::kRelative,
                  0.05, "tan^2 = -2 GM / BM: Rawson & Tupper, Basic Ship Theory"});
  return CaseResult{std::move(rows), {}};
}

Outcome sinkingObjects(gpu::Context& ctx, bool /*quick*/) {
  std::vector<Row> rows;
  core::Scene deep =
      openWater({Floater{.kind = FloaterKind::kStone, .y_m = -1.0, .size_m = 0.2, .density_ratio = 2.6}});
  deep.wave->depth_m = 20.0;
  auto stone = sim::WaterSim::create(ctx, deep);
  if (!stone) return stone.error();
  if (auto done = run(**stone, 240); !done) return done.error();
  rows.push_back({"terminal velocity of a ball of 20 cm", "m/s", -firstPose(**stone).velocity_y_mps,
                  std::sqrt(2 * 1.6 * kGravity_mps2 * 4.0 / 3.0 * 0.1 / 0.47), Tolerance::kRelative, 0.03,
                  "weight in water = 0.47 rho pi R^2 v^2 / 2"});

  // A hundred crates of 0.4 m in four layers, which fall on the bed.
  std::vector<Floater> heap;
  for (int i = 0; i < 100; ++i) {
    const int layer = i / 25;
    heap.push_back({.x_m = 0.45 * (i % 5 - 2) + 0.03 * layer,
                    .y_m = -1.7 + 0.45 * layer,
                    .z_m = 0.45 * (i / 5 % 5 - 2),
                    .heading_deg = 7.0 * (i % 7),
                    .size_m = 0.4,
                    .density_ratio = 2.0});
  }
  auto water = sim::WaterSim::create(ctx, openWater(std::move(heap)));
  if (!water) return water.error();
  const auto fastest_mps = [&] {
    double fastest = 0.0;
    for (const FloaterPose& pose : floaterPoses((*water)->copyState())) fastest = std::max(fastest, pose.speed_mps());
    return fastest;
  };
  if (auto done = run(**water, 600); !done) return done.error();
  rows.push_back({"fastest of 100 crates in a heap on the bed, after 10 s", "m/s", fastest_mps(), 0.02,
                  Tolerance::kAtMost, 0.0, "rest"});
  if (auto done = run(**water, 120); !done) return done.error();
  rows.push_back({"the same after 12 s", "m/s", fastest_mps(), 0.02, Tolerance::kAtMost, 0.0, "rest"});
  double lowest_m = 0.0;
  for (const FloaterPose& pose : floaterPoses((*water)->copyState())) lowest_m = std::min(lowest_m, pose.y_m);
  rows.push_back({"lowest centre of mass over the bed; flat on it 0.13", "m", 2.0 + lowest_m, 0.1, Tolerance::kAtLeast,
                  0.0, "nothing sinks into the bed"});
  return CaseResult{std::move(rows), {}};
}

}  // namespace spindrift::study
