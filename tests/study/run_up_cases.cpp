// Solitary waves of nonlinear shallow water on beaches, and in balance with dispersion over a level bed.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "canonical_run_up.h"
#include "cases.h"
#include "shallow_reference.h"
#include "shallow_water.h"
#include "ticks.h"

namespace spindrift::study {
namespace {

constexpr double kGravity_mps2 = 9.81;
/// Water thinner than this share of the depth does not count as wet when the waterline is read.
constexpr double kFilm = 1e-4;
constexpr double kBeachCotangent = 19.85;
/// Where the beach begins, a solitary wave has a twentieth of its height (Synolakis 1987).
const double kStartArgument = std::acosh(std::sqrt(20.0));

/// A solitary wave of height H in water of depth 1 m: H sech^2(gamma (x - x_0)), as the benchmarks define it.
struct SolitaryWave {
  double height_m;
  double crest_x_m;
  [[nodiscard]] double gamma_pm() const { return std::sqrt(0.75 * height_m); }
  [[nodiscard]] double at(double x_m) const {
    return height_m / std::pow(std::cosh(gamma_pm() * (x_m - crest_x_m)), 2);
  }
  [[nodiscard]] double halfLength_m() const { return kStartArgument / gamma_pm(); }
};

/// A channel 1 m deep with a plane beach at +x. The toe is at x = `toe_x_m` of the scene.
struct BeachChannel {
  core::Scene scene;
  double toe_x_m;
};

BeachChannel beachChannel(double cells_per_m, double offshore_m, double top_m, double courant) {
  const double cell_m = 1.0 / cells_per_m;
  const double beach_m = kBeachCotangent * (1.0 + top_m);
  const auto cells = static_cast<std::uint32_t>(std::ceil((offshore_m + beach_m) * cells_per_m));
  BeachChannel out{shallowChannel(cells, cell_m, 1.0, courant), 0.0};
  out.scene.beaches = {core::Beach{core::Side::kPlusX, beach_m, -top_m}};
  out.toe_x_m = out.scene.wave->side_m / 2 - beach_m;
  return out;
}

/// Puts a wave before the beach that runs toward it: with the speed of long waves, as the closed form has it, or with
/// that of a solitary wave, which keeps its shape where water disperses.
void startWave(sim::WaterSim& water, const BeachChannel& channel, const SolitaryWave& wave) {
  const double end_m = channel.toe_x_m + wave.halfLength_m();
  const bool disperses = channel.scene.wave->dispersion != core::Dispersion::kNone;
  const double speed_mps = std::sqrt(kGravity_mps2 * (disperses ? 1.0 + wave.height_m : 1.0));
  const auto velocity = [&](double eta_m) { return speed_mps * eta_m / (disperses ? 1.0 + eta_m : 1.0); };
  setShallowState(
      water, [&](double x, double) { return x < end_m ? wave.at(x) : 0.0; },
      [&](double x, double) { return x < end_m ? velocity(wave.at(x)) : 0.0; });
}

/// Highest point [m over the still water] that the water has reached after `duration_s`.
core::Result<double> runUp(gpu::Context& ctx, double height_m, double cells_per_m, double manning_spm13,
                           core::Dispersion dispersion) {
  const double half_m = kStartArgument / std::sqrt(0.75 * height_m);
  const double expected_m = std::max(2.831 * std::sqrt(kBeachCotangent) * std::pow(height_m, 1.25), 0.05);
  const double top_m = std::min(2.0 * expected_m, 1.0);
  BeachChannel channel = beachChannel(cells_per_m, 2.2 * half_m, top_m, 0.38);
  channel.scene.wave->manning_spm13 = manning_spm13;
  channel.scene.wave->dispersion = dispersion;
  const SolitaryWave wave{height_m, channel.toe_x_m - half_m};
  auto water = sim::WaterSim::create(ctx, channel.scene);
  if (!water) return water.error();
  const double speed_mps = std::sqrt(kGravity_mps2);
  startWave(**water, channel, wave);
  const std::vector<double> depth_m = groundDepths(channel.scene, *(*water)->derived().wave);
  const std::size_t nx = (*water)->derived().wave->count_x;
  const double duration_s = (half_m + 1.7 * kBeachCotangent + 3.0 * kBeachCotangent * expected_m) / speed_mps;
  double highest_m = 0.0;
  int tick_count = 0;
  auto done = runTo(**water, duration_s, [&] {
    if (++tick_count % 8 != 0 || (*water)->time_s() < 0.4 * duration_s) return;
    const std::vector<double> eta_m = (*water)->copyState().elevation_m;
    for (std::size_t x = nx; x-- > 0;) {
      const std::size_t i = x + nx;  // not the first row
      if (eta_m[i] + depth_m[i] <= kFilm) continue;
      highest_m = std::max(highest_m, eta_m[i]);
      break;
    }
  });
  if (!done) return done.error();
  return highest_m;
}

/// Root mean square of the differences over the span of the expected values; positions that should be dry do not count.
template <std::size_t N>
double relativeError(const std::array<double, N>& measured, const std::array<double, N>& expected) {
  double sum = 0.0, low = 0.0, high = 0.0;
  int count = 0;
  for (std::size_t k = 0; k < N; ++k) {
    if (std::isnan(expected[k])) continue;
    sum += std::pow(measured[k] - expected[k], 2);
    low = std::min(low, expected[k]);
    high = std::max(high, expected[k]);
    ++count;
  }
  return std::sqrt(sum / count) / (high - low);
}

/// Errors of the surface at the times of the canonical profiles, then of the records of the canonical gauges.
core::Result<std::vector<double>> canonicalErrors(gpu::Context& ctx, double cells_per_m) {
  using namespace canonical;
  SolitaryWave wave{0.019, 0.0};
  BeachChannel channel = beachChannel(cells_per_m, 2.2 * wave.halfLength_m(), 0.2, 0.38);
  wave.crest_x_m = channel.toe_x_m - wave.halfLength_m();
  auto water = sim::WaterSim::create(ctx, channel.scene);
  if (!water) return water.error();
  startWave(**water, channel, wave);
  const double shore_x_m = channel.toe_x_m + kBeachCotangent;
  const double unit_s = 1.0 / std::sqrt(kGravity_mps2);
  const auto levelAt = [&](const std::vector<double>& row, double place) {
    return betweenCells(row, (shore_x_m - place + channel.scene.wave->side_m / 2) * cells_per_m);
  };
  std::vector<double> out;
  std::array<std::array<double, kGauges[0].level.size()>, kGauges.size()> record{};
  const auto profile = [&](double time) {
    const auto due = std::ranges::find(kProfiles, time, &Profile::time);
    if (due == kProfiles.end()) return;
    const std::vector<double> row = rowOf(**water);
    std::array<double, kPlaces.size()> level{};
    std::ranges::transform(kPlaces, level.begin(), [&](double place) { return levelAt(row, place); });
    out.push_back(relativeError(level, due->level));
  };
  for (std::size_t sample = 0; sample < record[0].size(); ++sample) {
    const double time = kFirstTime + kInterval * static_cast<double>(sample);
    if (auto done = runTo(**water, time * unit_s); !done) return done.error();
    profile(time);
    const std::vector<double> row = rowOf(**water);
    for (std::size_t g = 0; g < kGauges.size(); ++g) record[g][sample] = levelAt(row, kGauges[g].place);
  }
  for (std::size_t g = 0; g < kGauges.size(); ++g) out.push_back(relativeError(record[g], kGauges[g].level));
  return out;
}

struct LaboratoryRun {
  double height;  ///< H/d
  double run_up;  ///< R/d
  bool breaks;
  const char* peer = "";  ///< what another solver reports
};

/// From Synolakis (1987), plane beach 1:19.85: means of the runs with nearly the same H/d.
constexpr std::array<LaboratoryRun, 7> kLaboratory = {{{0.0185, 0.0758, false, "; Celeris +0.11 %"},
                                                       {0.0275, 0.1155, false},
                                                       {0.039, 0.157, false},
                                                       {0.0765, 0.2545, true},
                                                       {0.16, 0.384, true},
                                                       {0.28, 0.511, true, "; Celeris -0.04 % at 0.3"},
                                                       {0.39, 0.631, true}}};
/// One roughness for all, as for the concrete of the island. The laboratory's water disperses: without dispersion waves
/// of more than 0.2 of the depth break too early and reach 10 % less.
constexpr double kLaboratoryManning = 0.012;
/// Run-up over depth of a wave of 0.019 by Synolakis's nonlinear theory, at t = 55 sqrt(d/g) (NTHMP benchmark 1).
constexpr double kClosedFormRunUp = 0.0912;
/// Cells per depth of 1 m at BALANCED, as in the scene `flume`.
constexpr double kLevelCells_pm = 10.0;

/// What is left of a solitary wave after 30 depths over a level bed, over its start and its speed in theory.
struct SolitaryWaveLeft {
  double height_ratio;
  double speed_ratio;
};

core::Result<SolitaryWaveLeft> afterThirtyDepths(gpu::Context& ctx, double height_m, double cells_per_m) {
  constexpr double kWay_m = 30.0;
  constexpr double kStart_m = 15.0;
  const auto cells = static_cast<std::uint32_t>((kStart_m + kWay_m + 15.0) * cells_per_m);
  core::Scene scene = shallowChannel(cells, 1.0 / cells_per_m, 1.0, 0.3);
  scene.wave->dispersion = core::Dispersion::kAiry;
  const double speed_mps = std::sqrt(kGravity_mps2 * (1.0 + height_m));
  const double from_m = kStart_m - scene.wave->side_m / 2;
  // The shape of Serre's solitary wave; its water moves as the shape does: u = c eta / (d + eta).
  const double gamma_pm = std::sqrt(0.75 * height_m / (1.0 + height_m));
  const auto eta = [&](double x) { return height_m / std::pow(std::cosh(gamma_pm * (x - from_m)), 2); };
  auto water = sim::WaterSim::create(ctx, scene);
  if (!water) return water.error();
  const double half_step_m = 0.5 * speed_mps * (*water)->derived().wave->dt_s;
  setShallowState(
      **water, [&](double x, double) { return eta(x); },
      [&](double x, double) { return speed_mps * eta(x + half_step_m) / (1.0 + eta(x + half_step_m)); });
  if (auto done = runTo(**water, kWay_m / speed_mps); !done) return done.error();
  const std::vector<double> eta_m = (*water)->copyState().elevation_m;
  const auto first = eta_m.begin() + cells;
  const auto top = std::max_element(first, first + cells);
  const auto at = static_cast<double>(top - first);
  const double bend = *(top - 1) - 2 * *top + *(top + 1);
  const double shift = 0.5 * (*(top - 1) - *(top + 1)) / bend;
  const double crest_m = *top - 0.25 * (*(top - 1) - *(top + 1)) * shift;
  const double way_m = (at + 0.5 + shift) / cells_per_m - kStart_m;
  return SolitaryWaveLeft{crest_m / height_m, way_m / ((*water)->time_s() * speed_mps)};
}

}  // namespace

Outcome solitaryRunUp(gpu::Context& ctx, bool quick) {
  std::vector<Row> rows;
  for (const double cells_per_m : {10.0, 20.0, 40.0}) {
    if (quick && cells_per_m != 20.0) continue;
    const auto reached_m = runUp(ctx, 0.019, cells_per_m, 0.0, core::Dispersion::kNone);
    if (!reached_m) return reached_m.error();
    const double tolerance = cells_per_m == 40.0 ? 0.012 : cells_per_m == 20.0 ? 0.035 : 0.06;
    rows.push_back(
        {fmt::format("slope 1:19.85, H/d = 0.019, without friction, {:.0f} cells a depth: run-up / d", cells_per_m), "",
         *reached_m, kClosedFormRunUp, Tolerance::kRelative, tolerance,
         "closed form (NTHMP benchmark 1); Celeris -1.27 %"});
  }
  for (const LaboratoryRun& run : kLaboratory) {
    if (quick && run.height != 0.0275) continue;
    const auto reached_m = runUp(ctx, run.height, 20.0, kLaboratoryManning, core::Dispersion::kAiry);
    if (!reached_m) return reached_m.error();
    rows.push_back({fmt::format("slope 1:19.85, H/d = {}, {}, Manning {}: run-up / d", run.height,
                                run.breaks ? "breaking" : "not breaking", kLaboratoryManning),
                    "", *reached_m, run.run_up, Tolerance::kRelative, run.breaks ? 0.08 : 0.05,
                    fmt::format("laboratory, Synolakis 1987 (NTHMP benchmark 4){}", run.peer)});
  }
  return CaseResult{std::move(rows), {}};
}

Outcome runUpProfiles(gpu::Context& ctx, bool quick) {
  std::vector<Row> rows;
  for (const double cells_per_m : {10.0, 20.0, 40.0}) {
    if (quick && cells_per_m != 10.0) continue;
    const auto errors = canonicalErrors(ctx, cells_per_m);
    if (!errors) return errors.error();
    const std::string name = fmt::format("slope 1:19.85, H/d = 0.019, {:.0f} cells a depth: ", cells_per_m);
    const auto row = [&](std::string what, double error) {
      rows.push_back({name + std::move(what), "%", 100 * error, 5.0, Tolerance::kAtMost, 0.0,
                      "closed form (NTHMP benchmark 1), root mean square over the span"});
    };
    for (std::size_t k = 0; k < canonical::kProfiles.size(); ++k)
      row(fmt::format("profile at t = {:.0f} sqrt(d/g)", canonical::kProfiles[k].time), (*errors)[k]);
    for (std::size_t g = 0; g < canonical::kGauges.size(); ++g)
      row(fmt::format("gauge at {} depths from the shore", canonical::kGauges[g].place),
          (*errors)[canonical::kProfiles.size() + g]);
  }
  return CaseResult{std::move(rows), {}};
}

Outcome solitaryWave(gpu::Context& ctx, bool quick) {
  std::vector<Row> rows;
  for (const double height_m : {0.1, 0.3}) {
    for (const double cells_per_m : {10.0, 20.0}) {
      if (quick && cells_per_m != 10.0) continue;
      const auto left = afterThirtyDepths(ctx, height_m, cells_per_m);
      if (!left) return left.error();
      const std::string name = fmt::format("H/d = {}, {:.0f} cells a depth", height_m, cells_per_m);
      rows.push_back({name + ": height after 30 depths / height", "", left->height_ratio, 1.0, Tolerance::kRelative,
                      0.05, "keeps its height"});
      rows.push_back({name + ": speed / sqrt(g (d + H))", "", left->speed_ratio, 1.0, Tolerance::kRelative, 0.035,
                      "solitary wave; REEF3D-SFLOW -0.2 %"});
    }
  }
  return CaseResult{std::move(rows), {}};
}

LevelError gentleRunUpError(gpu::Context& ctx, const LevelScale& level) {
  const auto reached_m = runUp(ctx, 0.019, kLevelCells_pm * level.cells, 0.0, core::Dispersion::kNone);
  if (!reached_m) return reached_m.error();
  return std::abs(*reached_m / kClosedFormRunUp - 1);
}

LevelError breakingRunUpError(gpu::Context& ctx, const LevelScale& level) {
  const LaboratoryRun& run = kLaboratory[5];
  const auto reached_m =
      runUp(ctx, run.height, kLevelCells_pm * level.cells, kLaboratoryManning, core::Dispersion::kAiry);
  if (!reached_m) return reached_m.error();
  return std::abs(*reached_m / run.run_up - 1);
}

LevelError solitaryHeightError(gpu::Context& ctx, const LevelScale& level) {
  const auto left = afterThirtyDepths(ctx, 0.3, kLevelCells_pm * level.cells);
  if (!left) return left.error();
  return std::abs(left->height_ratio - 1);
}

}  // namespace spindrift::study
