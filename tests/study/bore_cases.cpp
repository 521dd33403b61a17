// Bores of nonlinear shallow water: at a wall, over a breakwater, and as a wave that breaks on level ground.
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "cases.h"
#include "shallow_reference.h"
#include "shallow_water.h"
#include "ticks.h"

namespace spindrift::study {
namespace {

constexpr double kGravity_mps2 = 9.81;

/// A bore that runs into still water of depth `low_m`.
struct Bore {
  double low_m;
  double high_m;
  [[nodiscard]] double speed_mps() const { return std::sqrt(kGravity_mps2 * high_m * (low_m + high_m) / (2 * low_m)); }
  [[nodiscard]] double velocityBehind_mps() const { return speed_mps() * (1 - low_m / high_m); }
  /// Depth between a wall and the bore that it sends back.
  [[nodiscard]] double atWall_m() const {
    double below = high_m, above = 20 * high_m;
    for (int k = 0; k < 100; ++k) {
      const double h = (below + above) / 2;
      const double stops = (h - high_m) * std::sqrt(kGravity_mps2 * (h + high_m) / (2 * h * high_m));
      (stops < velocityBehind_mps() ? below : above) = h;
    }
    return below;
  }
  [[nodiscard]] double speedBack_mps() const { return high_m * velocityBehind_mps() / (atWall_m() - high_m); }
};

/// Where a row of values falls below `level` last, linear between the cells; cells are at first + k. 0: nowhere.
double lastCrossing(std::span<const double> row, double level) {
  for (std::size_t i = row.size() - 1; i-- > 0;) {
    if (row[i] > level && row[i + 1] <= level) return static_cast<double>(i) + (row[i] - level) / (row[i] - row[i + 1]);
  }
  return 0.0;
}

/// The same for the position where it rises above.
double firstRise(std::span<const double> row, double level) {
  for (std::size_t i = 0; i + 1 < row.size(); ++i) {
    if (row[i] <= level && row[i + 1] > level) return static_cast<double>(i) + (level - row[i]) / (row[i + 1] - row[i]);
  }
  return 0.0;
}

core::Result<void> boreAtWall(gpu::Context& ctx, std::uint32_t cells, std::vector<Row>& rows) {
  constexpr double kLength_m = 60.0, kStart_m = 40.0, kBehind_m = 4.0, kBeside_m = 5.0, kWayBack_m = 10.0;
  const Bore bore{1.0, 2.0};
  const double cell_m = kLength_m / cells;
  core::Scene scene = shallowChannel(cells, cell_m, bore.low_m, 0.5);
  scene.tick_rate_hz = (std::sqrt(kGravity_mps2 * bore.atWall_m()) + bore.velocityBehind_mps()) / (0.5 * cell_m);
  auto water = sim::WaterSim::create(ctx, scene);
  if (!water) return water.error();
  const double from_m = kStart_m - kLength_m / 2;
  setShallowState(
      **water, [&](double x, double) { return x < from_m ? bore.high_m - bore.low_m : 0.0; },
      [&](double x, double) { return x < from_m + 0.25 * cell_m ? bore.velocityBehind_mps() : 0.0; });
  const double to_wall_s = (kLength_m - kStart_m) / bore.speed_mps();
  const double middle_m = 0.5 * (bore.high_m - bore.low_m);
  struct Seen {
    double time_s;
    double front_m;
    std::vector<double> row;
  };
  const auto front = [&](double time_s, auto find) -> core::Result<Seen> {
    if (auto done = runTo(**water, time_s); !done) return done.error();
    Seen out{(*water)->time_s(), 0.0, rowOf(**water)};
    out.front_m = (find(out.row) + 0.5) * cell_m;
    return out;
  };
  const auto coming = [&](std::span<const double> row) { return lastCrossing(row, middle_m); };
  const double middle_back_m = 0.5 * (bore.high_m + bore.atWall_m()) - bore.low_m;
  const auto going = [&](std::span<const double> row) { return firstRise(row, middle_back_m); };
  const auto early = front(0.3 * to_wall_s, coming);
  if (!early) return early.error();
  const auto late = front(0.8 * to_wall_s, coming);
  if (!late) return late.error();
  const auto back = front(to_wall_s + 0.4 * kWayBack_m / bore.speedBack_mps(), going);
  if (!back) return back.error();
  const auto end = front(to_wall_s + kWayBack_m / bore.speedBack_mps(), going);
  if (!end) return end.error();
  const std::string name = fmt::format("1 m to 2 m, {} cells of {:.3g} m: ", cells, cell_m);
  const double speed_mps = (late->front_m - early->front_m) / (late->time_s - early->time_s);
  rows.push_back(
      {name + "speed of the bore", "m/s", speed_mps, bore.speed_mps(), Tolerance::kRelative, 0.003, "jump conditions"});
  const auto cellAt = [&](double x_m) { return static_cast<std::size_t>(std::clamp(x_m / cell_m, 0.0, cells - 1.0)); };
  const auto first = late->row.begin() + static_cast<std::ptrdiff_t>(cellAt(late->front_m - kBehind_m));
  const auto last = late->row.begin() + static_cast<std::ptrdiff_t>(cellAt(late->front_m + 1.0));
  const double highest_m = *std::max_element(first, last);
  const double step_m = bore.high_m - bore.low_m;
  rows.push_back({name + "overshoot behind the front / its height", "%", 100 * (highest_m - step_m) / step_m, 3.0,
                  Tolerance::kAtMost, 0.0, "none"});
  const std::span<const double> plateau(end->row.begin() + static_cast<std::ptrdiff_t>(cellAt(kLength_m - kBeside_m)),
                                        end->row.end());
  double sum_m = 0.0;
  for (const double level_m : plateau) sum_m += level_m;
  rows.push_back({name + "depth at the wall", "m", sum_m / static_cast<double>(plateau.size()) + bore.low_m,
                  bore.atWall_m(), Tolerance::kRelative, 0.001, "jump conditions"});
  rows.push_back({name + "speed of the bore that comes back", "m/s",
                  (back->front_m - end->front_m) / (end->time_s - back->time_s), bore.speedBack_mps(),
                  Tolerance::kRelative, 0.003, "jump conditions"});
  const auto [low, high] = std::ranges::minmax(plateau);
  rows.push_back({name + "ripples before the wall / height of the bore that comes back", "%",
                  100 * (high - low) / (bore.atWall_m() - bore.high_m), 0.0, Tolerance::kNone, 0.0, "none"});
  return {};
}

/// A breakwater with sides of 1:1.5 and a level crest 1 m wide, 0.3 m over the still water of 1 m, in a channel between
/// walls.
struct Breakwater {
  static constexpr double kLength_m = 30.0;
  static constexpr double kMiddle_m = 18.0;
  static constexpr double kCrest_m = 0.3;
  static constexpr double kBehind_m = 18.5;  ///< where the crest ends
  static constexpr double kDam_m = 10.0;     ///< the bore starts here
  static constexpr double kDuration_s = 8.0;
  Bore bore{1.0, 1.8};
  /// x counts from the first wall.
  static double ground_m(double x_m) {
    return std::clamp(kCrest_m - (std::abs(x_m - kMiddle_m) - 0.5) / 1.5, -1.0, kCrest_m);
  }
};

core::Result<double> overtoppedVolume(gpu::Context& ctx, std::uint32_t cells) {
  const Breakwater wall;
  const double cell_m = Breakwater::kLength_m / cells;
  const double half_m = Breakwater::kLength_m / 2;
  core::Scene scene = shallowChannel(cells, cell_m, wall.bore.low_m, 0.5);
  setBed(scene, [&](double x, double) { return -Breakwater::ground_m(x + half_m); });
  const double fastest_mps = std::sqrt(3 * kGravity_mps2) + wall.bore.velocityBehind_mps() + 1.0;
  const int ticks = fitTicks(scene, Breakwater::kDuration_s, 0.5 * cell_m / fastest_mps);
  auto water = sim::WaterSim::create(ctx, scene);
  if (!water) return water.error();
  const double dam_m = Breakwater::kDam_m - half_m;
  setShallowState(
      **water, [&](double x, double) { return x < dam_m ? wall.bore.high_m - wall.bore.low_m : 0.0; },
      [&](double x, double) { return x < dam_m + 0.25 * cell_m ? wall.bore.velocityBehind_mps() : 0.0; });
  const std::vector<double> x_m = placesAlong(**water);
  const auto behind_m2 = [&] {
    const std::vector<double> eta_m = rowOf(**water);
    double sum_m2 = 0.0;
    for (std::size_t i = 0; i < eta_m.size(); ++i)
      if (x_m[i] + half_m > Breakwater::kBehind_m) sum_m2 += eta_m[i] * cell_m;
    return sum_m2;
  };
  const double before_m2 = behind_m2();
  if (auto done = run(**water, ticks); !done) return done.error();
  return behind_m2() - before_m2;
}

double overtoppedReference(std::size_t cells) {
  const Breakwater wall;
  ShallowReference water(Breakwater::kLength_m, cells, &Breakwater::ground_m, [&](double x_m) {
    const bool is_behind = x_m < Breakwater::kDam_m;
    return ShallowReference::Water{is_behind ? wall.bore.high_m - wall.bore.low_m : 0.0,
                                   is_behind ? wall.bore.velocityBehind_mps() : 0.0};
  });
  const double before_m2 = water.waterBeyond(Breakwater::kBehind_m);
  water.advance(Breakwater::kDuration_s);
  return water.waterBeyond(Breakwater::kBehind_m) - before_m2;
}

}  // namespace

Outcome boreAtAWall(gpu::Context& ctx, bool quick) {
  std::vector<Row> rows;
  for (const std::uint32_t cells : {300U, 600U, 1200U}) {
    if (quick && cells != 600) continue;
    if (auto done = boreAtWall(ctx, cells, rows); !done) return done.error();
  }
  return CaseResult{std::move(rows), {}};
}

Outcome overtopping(gpu::Context& ctx, bool quick) {
  std::vector<Row> rows;
  const std::size_t reference_cells = quick ? 1600 : 6400;
  const double expected_m2 = overtoppedReference(reference_cells);
  for (const std::uint32_t cells : {100U, 200U, 400U, 800U}) {
    if (quick && cells != 400) continue;
    const auto volume_m2 = overtoppedVolume(ctx, cells);
    if (!volume_m2) return volume_m2.error();
    rows.push_back({fmt::format("bore of 1 to 1.8 m at a breakwater, {} cells: water behind it after {:.0f} s", cells,
                                Breakwater::kDuration_s),
                    "m^2", *volume_m2, expected_m2, cells < 200 ? Tolerance::kNone : Tolerance::kRelative, 0.03,
                    fmt::format("central-upwind scheme, {} cells", reference_cells)});
  }
  return CaseResult{std::move(rows), {}};
}

}  // namespace spindrift::study
