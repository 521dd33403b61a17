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
/// The laboratory's basin of 25 x 28.2 m begins at x = 0. The wave runs along the middle of the island, so half of it
/// is enough; what side and end send back comes after the end of the run. There is room for the wave before the gauges.
constexpr double kBefore_m = 4.0;
constexpr double kLength_m = 21.0;
constexpr double kWidth_m = 7.2;
constexpr double kIslandX_m = 12.96;
/// Distances from the laboratory's own side wall.
constexpr double kIslandZ_m = 13.80;
/// Where the crest is at the start.
constexpr double kCrestX_m = 1.5;
/// Of the concrete floor and the island.
constexpr double kManning = 0.012;
/// Thinner water does not count as wet.
constexpr double kFilm_m = 1e-3;

/// Run-up all round.
constexpr double kRunUpBound = 0.15;

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
  Place before;         ///< one of gauges 1 to 4; the mean of their crests
  std::array<Place, 4> gauges;
  std::array<RunUp, 24> run_up;
};

const std::array<Experiment, 2> kExperiments = {
    {{"A",
      0.045,
      {"gauges 1 to 4", 5.76, 13.05, 0.0142},
      {{{"gauge 6", 9.36, 13.80, 0.0149},
        {"gauge 9", 10.36, 13.80, 0.0221},
        {"gauge 16", 12.96, 11.22, 0.0201},
        {"gauge 22", 15.56, 13.80, 0.0170}}},
      {{{0, 0.0217},   {22.5, 0.0160},  {45, 0.0137},  {67.5, 0.0110},  {75, 0.0114},  {80, 0.0141},
        {85, 0.0206},  {87.5, 0.0206},  {90, 0.0225},  {92.5, 0.0217},  {95, 0.0206},  {100, 0.0118},
        {105, 0.0110}, {112.5, 0.0103}, {135, 0.0149}, {157.5, 0.0152}, {180, 0.0213}, {202.5, 0.0244},
        {225, 0.0251}, {247.5, 0.0320}, {270, 0.0320}, {292.5, 0.0305}, {315, 0.0303}, {337.5, 0.0244}}}},
     {"C",
      0.181,
      {"gauges 1 to 4", 7.56, 13.05, 0.0574},
      {{{"gauge 6", 9.36, 13.80, 0.0602},
        {"gauge 9", 10.36, 13.80, 0.0635},
        {"gauge 16", 12.96, 11.22, 0.0610},
        {"gauge 22", 15.56, 13.80, 0.0900}}},
      {{{0, 0.1040},   {22.5, 0.0671},  {45, 0.0392},  {67.5, 0.0335},  {75, 0.0591},  {80, 0.1002},
        {85, 0.1090},  {87.5, 0.1113},  {90, 0.1090},  {92.5, 0.1059},  {95, 0.1048},  {100, 0.0880},
        {105, 0.0541}, {112.5, 0.0442}, {135, 0.0381}, {157.5, 0.0602}, {180, 0.1010}, {202.5, 0.1295},
        {225, 0.1577}, {247.5, 0.1741}, {270, 0.1749}, {292.5, 0.1688}, {315, 0.1577}, {337.5, 0.1341}}}}}};

/// What a run has seen of the water.
struct Seen {
  std::vector<double> highest_m;    ///< highest surface of each cell while it was wet; -1 where it never was
  std::array<double, 5> crest_m{};  ///< highest at the gauges, the one before the island last
};

core::Result<Seen> run(gpu::Context& ctx, const core::Scene& scene, const Experiment& experiment) {
  auto water = sim::WaterSim::create(ctx, scene);
  if (!water) return water.error();
  const sim::WaveLayout& layout = *(*water)->derived().wave;
  const double height_m = experiment.height_ratio * kDepth_m;
  const double gamma_pm = std::sqrt(0.75 * experiment.height_ratio) / kDepth_m;
  const double crest_x_m = -layout.length_m / 2 + kBefore_m + kCrestX_m;
  const double speed_mps = std::sqrt(kGravity_mps2 * (kDepth_m + height_m));
  const auto eta = [&](double x) { return height_m / std::pow(std::cosh(gamma_pm * (x - crest_x_m)), 2); };
  setShallowState(
      **water, [&](double x, double) { return eta(x); },
      [&](double x, double) { return speed_mps * eta(x) / (kDepth_m + eta(x)); });
  const std::vector<double> depth_m = groundDepths(scene, layout);
  Seen out{std::vector<double>(depth_m.size(), -1.0)};
  std::array<std::size_t, 5> cells{};
  for (std::size_t k = 0; k < cells.size(); ++k) {
    const Place& gauge = k < experiment.gauges.size() ? experiment.gauges[k] : experiment.before;
    const auto x = static_cast<std::size_t>((gauge.x_m + kBefore_m) / layout.cell_m);
    const auto z = static_cast<std::size_t>(std::abs(gauge.z_m - kIslandZ_m) / layout.cell_m);
    cells[k] = x + layout.count_x * z;
  }
  // Until the waves that go round the island have met and run up its lee.
  const double duration_s = (kIslandX_m - kCrestX_m + 9.0) / speed_mps;
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

/// Highest water on dry ground within 2 degrees of an angle, or of its mirror image.
double runUpAt(const Seen& seen, const std::vector<double>& depth_m, const sim::WaveLayout& layout, double angle_deg) {
  const double folded_deg = angle_deg > 90.0 && angle_deg < 270.0 ? 180.0 - angle_deg : angle_deg;
  double highest_m = 0.0;
  for (std::size_t i = 0; i < depth_m.size(); ++i) {
    // The cells beside the waterline count, too: a crest may reach less than one cell of the slope.
    if (seen.highest_m[i] < 0 || depth_m[i] > 0.5 * layout.cell_m) continue;
    const double x_m = (static_cast<double>(i % layout.count_x) + 0.5) * layout.cell_m - kBefore_m - kIslandX_m;
    const double z_m = (static_cast<double>(i / layout.count_x) + 0.5) * layout.cell_m;
    if (std::hypot(x_m, z_m) > 3.7) continue;
    const double at_deg = std::atan2(x_m, z_m) * 180.0 / std::numbers::pi;
    const double apart_deg = std::remainder(at_deg - folded_deg, 360.0);
    if (std::abs(apart_deg) <= 2.0) highest_m = std::max(highest_m, seen.highest_m[i]);
  }
  return highest_m;
}

core::Result<void> measure(gpu::Context& ctx, const Experiment& experiment, double cell_m, bool quick,
                           std::vector<Row>& rows) {
  const char* const source = "Briggs et al. 1995";
  const auto cells = static_cast<std::uint32_t>(std::lround((kBefore_m + kLength_m) / cell_m));
  core::Scene scene = shallowScene(cells, cell_m, kDepth_m, 0.38);
  scene.wave->width_m = kWidth_m;
  scene.wave->manning_spm13 = kManning;
  scene.wave->dispersion = core::Dispersion::kAiry;
  scene.bed.emplace();
  scene.bed->shapes.emplace_back(core::BedCone{.x_m = kBefore_m + kIslandX_m - scene.wave->side_m / 2,
                                               .z_m = -kWidth_m / 2,
                                               .toe_radius_m = 3.6,
                                               .crest_radius_m = 1.1,
                                               .height_m = 0.625});
  const auto seen = run(ctx, scene, experiment);
  if (!seen) return seen.error();
  auto derived = sim::derive(scene);
  if (!derived) return derived.error();
  const std::vector<double> depth_m = groundDepths(scene, *derived->wave);
  const std::string name = fmt::format("case {}, cells of {:.1f} cm: ", experiment.name, 100 * cell_m);
  const auto crest = [&](const Place& gauge, double crest_m, bool is_judged) {
    rows.push_back({fmt::format("{}first crest at {}", name, gauge.name), "m", crest_m, gauge.crest_m,
                    is_judged ? Tolerance::kRelative : Tolerance::kNone, 0.08, source});
  };
  crest(experiment.before, seen->crest_m.back(), true);
  for (std::size_t k = 0; k < experiment.gauges.size(); ++k) crest(experiment.gauges[k], seen->crest_m[k], !quick);
  double worst_error = 0.0;
  int within_count = 0;
  for (const RunUp& each : experiment.run_up) {
    const double reached_m = runUpAt(*seen, depth_m, *derived->wave, each.angle_deg);
    const double error = reached_m / each.height_m - 1.0;
    if (std::abs(error) > std::abs(worst_error)) worst_error = error;
    if (std::abs(error) <= kRunUpBound) ++within_count;
    const bool is_facing = each.angle_deg == 270.0;
    if (quick && std::fmod(each.angle_deg, 45.0) != 0.0) continue;
    rows.push_back({fmt::format("{}run-up at {} degrees", name, each.angle_deg), "m", reached_m, each.height_m,
                    quick && !is_facing ? Tolerance::kNone : Tolerance::kRelative, kRunUpBound, source});
  }
  rows.push_back({fmt::format("{}angles within {:.0f} % of the run-up", name, 100 * kRunUpBound), "",
                  static_cast<double>(within_count), static_cast<double>(experiment.run_up.size()),
                  quick ? Tolerance::kNone : Tolerance::kAtLeast, 0.0, source});
  rows.push_back({name + "run-up, worst of all angles", "%", 100 * worst_error, 0.0, Tolerance::kNone, 0.0,
                  "Briggs et al. 1995; Celeris 0 to +81 %"});
  return {};
}

}  // namespace

Outcome conicalIsland(gpu::Context& ctx, bool quick) {
  std::vector<Row> rows;
  for (const Experiment& experiment : std::span(kExperiments).first(quick ? 1 : kExperiments.size())) {
    for (const double cell_m : quick ? std::vector{0.1} : std::vector{0.05, 0.025}) {
      if (auto done = measure(ctx, experiment, cell_m, quick, rows); !done) return done.error();
    }
  }
  return CaseResult{std::move(rows), {}};
}

}  // namespace spindrift::study
