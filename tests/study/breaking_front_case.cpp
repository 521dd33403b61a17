// A wave that steepens into a bore on level ground, at several resolutions and at the levels of fidelity.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "cases.h"
#include "shallow_reference.h"
#include "shallow_water.h"
#include "ticks.h"

namespace spindrift::study {
namespace {

constexpr double kGravity_mps2 = 9.81;
constexpr double kLength_m = 24.0;
constexpr double kDepth_m = 1.0;
constexpr double kHeight_m = 0.4;
constexpr double kDuration_s = 6.0;
/// A front has arrived when the water is this high.
constexpr double kArrived_m = kHeight_m / 4;
constexpr std::array<double, 4> kGauges_m = {8.0, 12.0, 16.0, 20.0};
/// Samples of the reference.
constexpr double kSamples_hz = 600.0;

/// A sech^2 crest 4 m from the first wall. x counts from that wall.
double startLevel(double x_m) {
  return kHeight_m / std::pow(std::cosh((x_m - 4.0) / 1.5), 2);
}
/// The velocity with which all of it runs toward +x.
double simpleWave(double level_m) {
  return 2 * (std::sqrt(kGravity_mps2 * (kDepth_m + level_m)) - std::sqrt(kGravity_mps2 * kDepth_m));
}

/// Levels at the gauges, one sample after the other.
struct Record {
  double sample_s;
  std::vector<std::array<double, 4>> level_m;

  [[nodiscard]] double crest_m(std::size_t gauge) const {
    double highest_m = 0.0;
    for (const auto& sample : level_m) highest_m = std::max(highest_m, sample[gauge]);
    return highest_m;
  }
  [[nodiscard]] double arrival_s(std::size_t gauge) const {
    for (std::size_t k = 1; k < level_m.size(); ++k) {
      const double before_m = level_m[k - 1][gauge], here_m = level_m[k][gauge];
      if (here_m > kArrived_m)
        return sample_s * (static_cast<double>(k - 1) + (kArrived_m - before_m) / (here_m - before_m));
    }
    return 0.0;
  }
};

Record referenceRecord(std::size_t cells) {
  ShallowReference water(
      kLength_m, cells, [](double) { return -kDepth_m; },
      [](double x_m) {
        return ShallowReference::Water{startLevel(x_m), simpleWave(startLevel(x_m))};
      });
  Record out{1.0 / kSamples_hz, {}};
  const auto sample = [&] {
    std::array<double, 4> level_m{};
    for (std::size_t g = 0; g < level_m.size(); ++g) level_m[g] = water.levelAt(kGauges_m[g]);
    out.level_m.push_back(level_m);
  };
  sample();
  for (int k = 0; k < static_cast<int>(kDuration_s * kSamples_hz); ++k) {
    water.advance(out.sample_s);
    sample();
  }
  return out;
}

/// One sample per tick of the scene.
core::Result<Record> measuredRecord(gpu::Context& ctx, const core::Scene& scene) {
  auto water = sim::WaterSim::create(ctx, scene);
  if (!water) return water.error();
  const sim::WaveLayout& layout = *(*water)->derived().wave;
  const double half_step_m = 0.5 * layout.dt_s * std::sqrt(kGravity_mps2 * kDepth_m);
  const double half_m = kLength_m / 2;
  setShallowState(
      **water, [&](double x, double) { return startLevel(x + half_m); },
      [&](double x, double) { return simpleWave(startLevel(x + half_m + half_step_m)); });
  Record out{1.0 / scene.tick_rate_hz, {}};
  const auto sample = [&] {
    const std::vector<double> eta_m = rowOf(**water);
    std::array<double, 4> level_m{};
    for (std::size_t g = 0; g < level_m.size(); ++g) level_m[g] = betweenCells(eta_m, kGauges_m[g] / layout.cell_m);
    out.level_m.push_back(level_m);
  };
  sample();
  const int ticks = static_cast<int>(std::lround(kDuration_s * scene.tick_rate_hz));
  if (auto done = run(**water, ticks, sample); !done) return done.error();
  return out;
}

/// Mean difference over the gauges, at the ticks of a room at 60 Hz. [m]
double meanDifference(const Record& a, const Record& b) {
  constexpr int kTicks = static_cast<int>(kDuration_s * 60);
  double sum_m = 0.0;
  const auto at = [](const Record& record, int tick) -> const std::array<double, 4>& {
    return record.level_m[static_cast<std::size_t>(std::lround(tick / (60 * record.sample_s)))];
  };
  for (int tick = 1; tick <= kTicks; ++tick) {
    for (std::size_t g = 0; g < kGauges_m.size(); ++g) sum_m += std::abs(at(a, tick)[g] - at(b, tick)[g]);
  }
  return sum_m / (kTicks * kGauges_m.size());
}

core::Result<void> atResolutions(gpu::Context& ctx, const Record& exact, bool quick, const std::string& source,
                                 std::vector<Row>& rows) {
  double before_s = 0.0;
  for (const std::uint32_t cells : {96U, 192U, 384U, 768U}) {
    if (quick && cells != 192 && cells != 384) continue;
    const double cell_m = kLength_m / cells;
    core::Scene scene = shallowChannel(cells, cell_m, kDepth_m, 0.5);
    fitTicks(scene, kDuration_s, 0.5 * cell_m / (std::sqrt(kGravity_mps2 * (kDepth_m + kHeight_m)) + 1.1));
    const auto record = measuredRecord(ctx, scene);
    if (!record) return record.error();
    double late_s = 0.0;
    for (std::size_t g = 0; g < kGauges_m.size(); ++g) {
      rows.push_back({fmt::format("{} cells: crest {:.0f} m from the wall", cells, kGauges_m[g]), "m",
                      record->crest_m(g), exact.crest_m(g), cells < 192 ? Tolerance::kNone : Tolerance::kRelative, 0.03,
                      source});
      late_s += std::abs(record->arrival_s(g) - exact.arrival_s(g)) / kGauges_m.size();
    }
    rows.push_back({fmt::format("{} cells: error of the front's arrival, mean of the gauges", cells), "ms",
                    1e3 * late_s, 0.0, Tolerance::kNone, 0.0, source});
    if (before_s > 0)
      rows.push_back({fmt::format("{} cells: error of the arrival, times less than with half as many", cells), "",
                      before_s / late_s, 2.0, Tolerance::kAtLeast, 0.0, "first order at fronts"});
    before_s = late_s;
  }
  return {};
}

/// Cells and tick rate of BALANCED.
constexpr double kBalancedCells = 192;
constexpr double kBalancedTicks_hz = 60.0;

/// Mean difference at the gauges over the height of the wave.
LevelError differenceAtLevel(gpu::Context& ctx, const Record& exact, const LevelScale& level) {
  const auto cells = static_cast<std::uint32_t>(kBalancedCells * level.cells);
  core::Scene scene = shallowChannel(cells, kLength_m / cells, kDepth_m, 0.5);
  // As a room runs it: the rule chooses the steps.
  scene.allow_unstable = false;
  scene.wave->fixed_substeps_count = 0;
  scene.tick_rate_hz = kBalancedTicks_hz * level.ticks;
  const auto record = measuredRecord(ctx, scene);
  if (!record) return record.error();
  return meanDifference(*record, exact) / kHeight_m;
}

core::Result<void> atLevels(gpu::Context& ctx, const Record& exact, const std::string& source, std::vector<Row>& rows) {
  double before = 0.0, before_cells = 0.0;
  for (const LevelScale& level : kLevelScales) {
    const auto off = differenceAtLevel(ctx, exact, level);
    if (!off) return off.error();
    rows.push_back({fmt::format("fidelity {}, {} cells: mean difference at the gauges / height", level.name,
                                kBalancedCells * level.cells),
                    "%", 100 * *off, 0.0, Tolerance::kNone, 0.0, source});
    if (before > 0)
      rows.push_back({fmt::format("fidelity {}: the difference falls per doubling of the cells by", level.name), "",
                      std::pow(before / *off, 1 / std::log2(level.cells / before_cells)), 1.6, Tolerance::kAtLeast, 0.0,
                      "first order at fronts"});
    before = *off;
    before_cells = level.cells;
  }
  return {};
}

}  // namespace

Outcome breakingFront(gpu::Context& ctx, bool quick) {
  std::vector<Row> rows;
  const std::size_t cells = quick ? 3072 : 6144;
  const Record exact = referenceRecord(cells);
  const std::string source = fmt::format("central-upwind scheme, {} cells", cells);
  if (auto done = atResolutions(ctx, exact, quick, source, rows); !done) return done.error();
  if (auto done = atLevels(ctx, exact, source, rows); !done) return done.error();
  return CaseResult{std::move(rows), {}};
}

LevelError boreError(gpu::Context& ctx, const LevelScale& level) {
  static const Record exact = referenceRecord(3072);
  return differenceAtLevel(ctx, exact, level);
}

}  // namespace spindrift::study
