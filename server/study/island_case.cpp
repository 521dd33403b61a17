// Solitary waves that meet a conical island in a laboratory basin (Briggs et al. 1995; NTHMP benchmark 6).
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <spindrift/sim_setup/derive.h>

#include "cases.h"
#include "shallow_water.h"
#include "ticks.h"

namespace spindrift::study {
namespace {

constexpr double kGravity_mps2 = 9.81;
constexpr double kDepth_m = 0.32;
/// The laboratory's basin begins at x = 0; ours has room for the wave before it.
constexpr double kLength_m = 25.0;
constexpr double kWidth_m = 28.2;
constexpr double kBefore_m = 14.0;
constexpr double kIslandX_m = 12.96;
constexpr double kIslandZ_m = 13.80;
/// Of the concrete floor and the island.
constexpr double kManning = 0.012;
/// Thinner water does not count as wet.
constexpr double kFilm_m = 1e-3;

struct Place {
  const char* name;
  double x_m, z_m;
  double crest_m;  ///< height of the first crest over the still water
};

/// Run-up at an angle: 270 degrees faces the wave, 90 is the lee.
struct RunUp {
  double angle_deg;
  double height_m;
};

struct Experiment {
  const char* name;
  double height_ratio;  ///< measured H/d
  std::array<Place, 4> gauges;
  std::array<RunUp, 24> run_up;
};

const std::array<Experiment, 2> kExperiments = {
    {{"A",
      0.045,
      {{{"6", 9.36, 13.80, 0.0149},
        {"9", 10.36, 13.80, 0.0221},
        {"16", 12.96, 11.22, 0.0201},
        {"22", 15.56, 13.80, 0.0133}}},
      {{{0, 0.0217},   {22.5, 0.0160},  {45, 0.0137},  {67.5, 0.0110},  {75, 0.0114},  {80, 0.0141},
        {85, 0.0206},  {87.5, 0.0206},  {90, 0.0225},  {92.5, 0.0217},  {95, 0.0206},  {100, 0.0118},
        {105, 0.0110}, {112.5, 0.0103}, {135, 0.0149}, {157.5, 0.0152}, {180, 0.0213}, {202.5, 0.0244},
        {225, 0.0251}, {247.5, 0.0320}, {270, 0.0320}, {292.5, 0.0305}, {315, 0.0303}, {337.5, 0.0244}}}},
     {"C",
      0.181,
      {{{"6", 9.36, 13.80, 0.0602},
        {"9", 10.36, 13.80, 0.0635},
        {"16", 12.96, 11.22, 0.0610},
        {"22", 15.56, 13.80, 0.0900}}},
      {{{0, 0.1040},   {22.5, 0.0671},  {45, 0.0392},  {67.5, 0.0335},  {75, 0.0591},  {80, 0.1002},
        {85, 0.1090},  {87.5, 0.1113},  {90, 0.1090},  {92.5, 0.1059},  {95, 0.1048},  {100, 0.0880},
        {105, 0.0541}, {112.5, 0.0442}, {135, 0.0381}, {157.5, 0.0602}, {180, 0.1010}, {202.5, 0.1295},
        {225, 0.1577}, {247.5, 0.1741}, {270, 0.1749}, {292.5, 0.1688}, {315, 0.1577}, {337.5, 0.1341}}}}}};

/// What a run has seen of the water.
struct Seen {
  std::vector<double> highest_m;  ///< highest surface of each cell while it was wet; -1 where it never was
  std::array<double, 4> crest_m{};
};

core::Result<Seen> run(gpu::Context& ctx, const core::Scene& scene, const Experiment& experiment) {
  auto water = sim::WaterSim::create(ctx, scene);
  if (!water) return water.error();
  const sim::WaveLayout& layout = *(*water)->derived().wave;
  const double height_m = experiment.height_ratio * kDepth_m;
  const double gamma_pm = std::sqrt(0.75 * experiment.height_ratio) / kDepth_m;
  const double crest_x_m = -layout.length_m / 2 + kBefore_m / 2;
  const double speed_mps = std::sqrt(kGravity_mps2 * (kDepth_m + height_m));
  const auto eta = [&](double x) { return height_m / std::pow(std::cosh(gamma_pm * (x - crest_x_m)), 2); };
  setShallowState(
      **water, [&](double x, double) { return eta(x); },
      [&](double x, double) { return speed_mps * eta(x) / (kDepth_m + eta(x)); });
  const std::vector<double> depth_m = groundDepths(scene, layout);
  Seen out{std::vector<double>(depth_m.size(), -1.0)};
  std::array<std::size_t, 4> cells{};
  for (std::size_t k = 0; k < cells.size(); ++k) {
    const auto x = static_cast<std::size_t>((experiment.gauges[k].x_m + kBefore_m) / layout.cell_m);
    const auto z = static_cast<std::size_t>(experiment.gauges[k].z_m / layout.cell_m);
    cells[k] = x + layout.count_x * z;
  }
  // Until the waves that go round the island have met and run up its lee.
  const double duration_s = (kBefore_m / 2 + kIslandX_m + 7.0) / speed_mps;
  int tick_count = 0;
  auto done = runTo(**water, duration_s, [&] {
    if (++tick_count % 4 != 0) return;
    const std::vector<double> eta_m = (*water)->copyState().elevation_m;
    for (std::size_t i = 0; i < eta_m.size(); ++i) {
      if (eta_m[i] + depth_m[i] > kFilm_m) out.highest_m[i] = std::max(out.highest_m[i], eta_m[i]);
    }
    for (std::size_t k = 0; k < cells.size(); ++k) out.crest_m[k] = std::max(out.crest_m[k], eta_m[cells[k]]);
  });
  if (!done) return done.error();
  return out;
}

/// Highest water on dry ground within 3 degrees of an angle.
double runUpAt(const Seen& seen, const std::vector<double>& depth_m, const sim::WaveLayout& layout, double angle_deg) {
  double highest_m = 0.0;
  for (std::size_t i = 0; i < depth_m.size(); ++i) {
    // The cells beside the waterline count, too: a crest may reach less than one cell of the slope.
    if (seen.highest_m[i] < 0 || depth_m[i] > 0.5 * layout.cell_m) continue;
    const double x_m = (static_cast<double>(i % layout.count_x) + 0.5) * layout.cell_m - kBefore_m - kIslandX_m;
    const double z_m = (static_cast<double>(i / layout.count_x) + 0.5) * layout.cell_m - kIslandZ_m;
    if (std::hypot(x_m, z_m) > 3.7) continue;
    const double at_deg = std::atan2(x_m, z_m) * 180.0 / std::numbers::pi;
    const double apart_deg = std::remainder(at_deg - angle_deg, 360.0);
    if (std::abs(apart_deg) <= 3.0) highest_m = std::max(highest_m, seen.highest_m[i]);
  }
  return highest_m;
}

}  // namespace

Outcome conicalIsland(gpu::Context& ctx, bool quick) {
  const double cell_m = quick ? 0.1 : 0.05;
  std::vector<Row> rows;
  for (const Experiment& experiment : std::span(kExperiments).first(quick ? 1 : kExperiments.size())) {
    const auto cells = static_cast<std::uint32_t>(std::lround((kBefore_m + kLength_m) / cell_m));
    core::Scene scene = shallowScene(cells, cell_m, kDepth_m, 0.38);
    scene.wave->width_m = kWidth_m;
    scene.wave->manning_spm13 = kManning;
    scene.wave->dispersion = core::Dispersion::kAiry;
    scene.bed.emplace();
    scene.bed->shapes.emplace_back(core::BedCone{.x_m = kBefore_m + kIslandX_m - scene.wave->side_m / 2,
                                                 .z_m = kIslandZ_m - kWidth_m / 2,
                                                 .toe_radius_m = 3.6,
                                                 .crest_radius_m = 1.1,
                                                 .height_m = 0.625});
    const auto seen = run(ctx, scene, experiment);
    if (!seen) return seen.error();
    auto derived = sim::derive(scene);
    if (!derived) return derived.error();
    const std::vector<double> depth_m = groundDepths(scene, *derived->wave);
    double worst_error = 0.0;
    for (const RunUp& each : experiment.run_up) {
      const double reached_m = runUpAt(*seen, depth_m, *derived->wave, each.angle_deg);
      const double error = reached_m / each.height_m - 1.0;
      if (std::abs(error) > std::abs(worst_error)) worst_error = error;
      if (std::fmod(each.angle_deg, 45.0) != 0.0) continue;
      rows.push_back({fmt::format("case {}: run-up at {:.0f} degrees", experiment.name, each.angle_deg), "m", reached_m,
                      each.height_m, each.angle_deg == 270.0 ? Tolerance::kRelative : Tolerance::kNone, 0.15,
                      "Briggs et al. 1995"});
    }
    rows.push_back({fmt::format("case {}: run-up, worst of 24 angles", experiment.name), "%",
                    100 * std::abs(worst_error), 15.0, quick ? Tolerance::kNone : Tolerance::kAtMost, 0.0,
                    "Briggs et al. 1995; Celeris 0 to +81 %"});
    for (std::size_t k = 0; k < experiment.gauges.size(); ++k) {
      const Place& gauge = experiment.gauges[k];
      rows.push_back({fmt::format("case {}: first crest at gauge {}", experiment.name, gauge.name), "m",
                      seen->crest_m[k], gauge.crest_m, quick ? Tolerance::kNone : Tolerance::kRelative, 0.08,
                      "Briggs et al. 1995"});
    }
  }
  return CaseResult{std::move(rows), {}};
}

}  // namespace spindrift::study
