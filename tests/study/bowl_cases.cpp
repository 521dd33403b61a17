// Water that swings in parabolic bowls with a moving shore (Thacker 1981), and in closed basins.
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include "cases.h"
#include "exact_linear_waves.h"
#include "shallow_water.h"
#include "ticks.h"

namespace spindrift::study {
namespace {

using std::numbers::pi;

constexpr double kGravity_mps2 = 9.81;
/// The bowl: depth h (1 - r^2/a^2), on a square or line of `kSide_m`; farther out the ground is level land.
constexpr double kDepth_m = 1.0;
constexpr double kRadius_m = 10.0;
constexpr double kSide_m = 30.0;
constexpr double kLand_m = 1.24;
/// Velocity of the planar swing.
constexpr double kSwing_mps = 1.0;
const double kPlanarOmega_radps = std::sqrt(2 * kGravity_mps2 * kDepth_m) / kRadius_m;

double bowlDepth(double r2_m2) {
  return std::max(kDepth_m * (1 - r2_m2 / (kRadius_m * kRadius_m)), -kLand_m);
}

/// Amplitude and phase of a record of whole periods, `per_period` samples each, of which the last is at the end of one.
std::complex<double> lastPeriod(const std::vector<double>& record, std::size_t per_period) {
  std::complex<double> sum = 0.0;
  for (std::size_t k = 1; k <= per_period; ++k) {
    const double phase = 2 * pi * static_cast<double>(k) / static_cast<double>(per_period);
    sum += record[record.size() - 1 - per_period + k] * std::polar(2.0 / static_cast<double>(per_period), phase);
  }
  return sum;
}

struct Swing {
  double amplitude;     ///< of the last period, over the exact one
  double period_error;  ///< longer than exact: positive
};

/// The centre of the water in a bowl that does not vary along z.
core::Result<Swing> planarSwing(gpu::Context& ctx, std::uint32_t cells, int period_count) {
  constexpr std::size_t kPerPeriod = 20;
  const double cell_m = kSide_m / cells;
  const double reach_m = kSwing_mps / kPlanarOmega_radps;
  core::Scene scene = shallowChannel(cells, cell_m, kDepth_m, 0.5);
  setBed(scene, [](double x, double) { return bowlDepth(x * x); });
  const double sample_s = 2 * pi / kPlanarOmega_radps / kPerPeriod;
  const int ticks = fitTicks(scene, sample_s, 0.5 * cell_m / (std::sqrt(kGravity_mps2 * kDepth_m) + kSwing_mps));
  auto water = sim::WaterSim::create(ctx, scene);
  if (!water) return water.error();
  const double half_tick_s = 0.5 / scene.tick_rate_hz;
  setShallowState(
      **water,
      [&](double x, double) { return kDepth_m * (1 - std::pow((x + reach_m) / kRadius_m, 2)) - bowlDepth(x * x); },
      [&](double, double) { return kSwing_mps * std::sin(-kPlanarOmega_radps * half_tick_s); });
  const std::vector<double> depth_m = groundDepths(scene, *(*water)->derived().wave);
  const std::vector<double> x_m = placesAlong(**water);
  std::vector<double> centre_m;
  for (std::size_t sample = 0; sample < kPerPeriod * static_cast<std::size_t>(period_count); ++sample) {
    if (auto done = run(**water, ticks); !done) return done.error();
    const std::vector<double> eta_m = rowOf(**water);
    double sum = 0.0, total = 0.0;
    for (std::size_t i = 0; i < eta_m.size(); ++i) {
      const double here_m = eta_m[i] + depth_m[i];
      sum += here_m * x_m[i];
      total += here_m;
    }
    centre_m.push_back(sum / total);
  }
  // Exact: -reach cos(omega t).
  const std::complex<double> last = -lastPeriod(centre_m, kPerPeriod);
  return Swing{std::abs(last) / reach_m, std::arg(last) / (2 * pi * (period_count - 0.5))};
}

/// A state that comes back after every period.
struct Bowl {
  const char* name;
  double omega_radps;
  double fastest_mps;
  Field2 depth_m;  ///< water at t = 0
  std::function<Field2(double time_s)> u_mps, w_mps;
};

Bowl planarBowl() {
  const double reach_m = kSwing_mps / kPlanarOmega_radps;
  const double omega = kPlanarOmega_radps;
  return {"planar",
          omega,
          std::sqrt(1.25 * kGravity_mps2 * kDepth_m) + kSwing_mps,
          [=](double x, double z) {
            const double r2 = std::pow(x + reach_m, 2) + z * z;
            return std::max(kDepth_m * (1 - r2 / (kRadius_m * kRadius_m)), 0.0);
          },
          [=](double t) { return [=](double, double) { return kSwing_mps * std::sin(omega * t); }; },
          [=](double t) { return [=](double, double) { return -kSwing_mps * std::cos(omega * t); }; }};
}

/// At the start the water is a paraboloid with its shore at 8 m.
Bowl curvedBowl() {
  const double omega = std::sqrt(8 * kGravity_mps2 * kDepth_m) / kRadius_m;
  const double a4 = std::pow(kRadius_m, 4), r4 = std::pow(8.0, 4);
  const double c = (a4 - r4) / (a4 + r4);
  const auto rate = [=](double t) { return 0.5 * omega * c * std::sin(omega * t) / (1 - c * std::cos(omega * t)); };
  return {"curved",
          omega,
          std::sqrt(1.25 * kGravity_mps2 * kDepth_m) + 1.5,
          [=](double x, double z) {
            const double r2 = (x * x + z * z) / (kRadius_m * kRadius_m);
            return std::max(kDepth_m * (std::sqrt(1 - c * c) / (1 - c) - r2 * (1 - c * c) / ((1 - c) * (1 - c))), 0.0);
          },
          [=](double t) { return [=](double x, double) { return rate(t) * x; }; },
          [=](double t) { return [=](double, double z) { return rate(t) * z; }; }};
}

/// Largest error of the depth after whole periods, over all water.
core::Result<double> bowlError(gpu::Context& ctx, const Bowl& bowl, std::uint32_t cells, int period_count) {
  const double cell_m = kSide_m / cells;
  core::Scene scene = shallowScene(cells, cell_m, kDepth_m, 0.5);
  setBed(scene, [](double x, double z) { return bowlDepth(x * x + z * z); });
  const int ticks = fitTicks(scene, 2 * pi / bowl.omega_radps, 0.5 * cell_m / bowl.fastest_mps);
  auto water = sim::WaterSim::create(ctx, scene);
  if (!water) return water.error();
  const double half_tick_s = 0.5 / scene.tick_rate_hz;
  setShallowState(
      **water, [&](double x, double z) { return bowl.depth_m(x, z) - bowlDepth(x * x + z * z); },
      bowl.u_mps(-half_tick_s), bowl.w_mps(-half_tick_s));
  const std::vector<double> ground_m = groundDepths(scene, *(*water)->derived().wave);
  const std::vector<double> start_m = (*water)->copyState().elevation_m;
  double worst = 0.0;
  for (int period = 0; period < period_count; ++period) {
    if (auto done = run(**water, ticks); !done) return done.error();
    const std::vector<double> eta_m = (*water)->copyState().elevation_m;
    double off = 0.0, total = 0.0;
    for (std::size_t i = 0; i < eta_m.size(); ++i) {
      off += std::abs(eta_m[i] - start_m[i]);
      total += start_m[i] + ground_m[i];
    }
    worst = std::max(worst, off / total);
  }
  return worst;
}

}  // namespace

Outcome thackersBowl(gpu::Context& ctx, bool quick) {
  std::vector<Row> rows;
  constexpr int kPeriods = 10;
  for (const std::uint32_t cells : {100U, 200U, 400U}) {
    if (quick && cells != 200) continue;
    const auto swing = planarSwing(ctx, cells, kPeriods);
    if (!swing) return swing.error();
    const std::string name = fmt::format("planar bowl along x, {} cells, {} periods", cells, kPeriods);
    const bool is_judged = cells >= 200;
    rows.push_back({name + ": amplitude left", "", swing->amplitude, 1.0,
                    is_judged ? Tolerance::kRelative : Tolerance::kNone, 0.005, "Thacker 1981"});
    rows.push_back({name + ": error of the period", "", swing->period_error, 0.0,
                    is_judged ? Tolerance::kAbsolute : Tolerance::kNone, 1e-4, "Thacker 1981"});
  }
  for (const auto& [bowl, bound_percent] : {std::pair{planarBowl(), 0.35}, {curvedBowl(), 3.0}}) {
    for (const std::uint32_t cells : {60U, 120U}) {
      if (quick && cells != 120) continue;
      const auto error = bowlError(ctx, bowl, cells, 3);
      if (!error) return error.error();
      rows.push_back(
          {fmt::format("{} bowl, {} x {} cells, 3 periods: error of the depth over the water", bowl.name, cells, cells),
           "%", 100 * *error, bound_percent, cells == 120 ? Tolerance::kAtMost : Tolerance::kNone, 0.0,
           "Thacker 1981"});
    }
  }
  return CaseResult{std::move(rows), {}};
}

Outcome seiche(gpu::Context& ctx, bool quick) {
  std::vector<Row> rows;
  constexpr double kHeight_m = 1e-3;
  constexpr int kPeriods = 20;
  constexpr std::size_t kPerPeriod = 20;
  struct Basin {
    double length_m;
    bool disperses;
  };
  for (const Basin& basin : {Basin{20.0, false}, {20.0, true}, {4.0, true}, {2.0, true}}) {
    for (const std::uint32_t cells : {20U, 40U}) {
      if (quick && cells != 20) continue;
      const double cell_m = basin.length_m / cells;
      const double k_radpm = pi / basin.length_m;
      const double omega = basin.disperses ? AiryWater{kGravity_mps2, kDepth_m}.omega_radps(k_radpm)
                                           : k_radpm * std::sqrt(kGravity_mps2 * kDepth_m);
      core::Scene scene = shallowChannel(cells, cell_m, kDepth_m, 0.5);
      if (basin.disperses) scene.wave->dispersion = core::Dispersion::kAiry;
      const int ticks =
          fitTicks(scene, 2 * pi / omega / kPerPeriod, 0.5 * cell_m / std::sqrt(kGravity_mps2 * kDepth_m));
      auto water = sim::WaterSim::create(ctx, scene);
      if (!water) return water.error();
      const double before = std::sin(0.5 * omega / scene.tick_rate_hz);
      const auto mode = [&](double x) { return std::cos(k_radpm * (x + basin.length_m / 2)); };
      setShallowState(
          **water, [&](double x, double) { return kHeight_m * mode(x); },
          [&](double x, double) {
            return -omega / (k_radpm * kDepth_m) * kHeight_m * std::sin(k_radpm * (x + basin.length_m / 2)) * before;
          });
      const std::vector<double> x_m = placesAlong(**water);
      std::vector<double> record;
      for (std::size_t sample = 0; sample < kPeriods * kPerPeriod; ++sample) {
        if (auto done = run(**water, ticks); !done) return done.error();
        const std::vector<double> eta_m = rowOf(**water);
        double sum = 0.0;
        for (std::size_t i = 0; i < eta_m.size(); ++i) sum += eta_m[i] * mode(x_m[i]);
        record.push_back(2 * sum / (kHeight_m * cells));
      }
      const std::complex<double> last = lastPeriod(record, kPerPeriod);
      const std::string name = fmt::format("basin of {:.0f} depths, {} cells{}", basin.length_m / kDepth_m, cells,
                                           basin.disperses ? ", with dispersion" : "");
      rows.push_back({name + ": error of the period", "%", 100 * std::arg(last) / (2 * pi * (kPeriods - 0.5)), 0.0,
                      Tolerance::kAbsolute, basin.disperses ? 1.0 : 0.1,
                      basin.disperses ? "omega^2 = g k tanh(k d)" : "omega = k sqrt(g d)"});
      rows.push_back({fmt::format("{}: amplitude left after {} periods", name, kPeriods), "", std::abs(last), 0.99,
                      Tolerance::kAtLeast, 0.0, "no losses"});
    }
  }
  return CaseResult{std::move(rows), {}};
}

}  // namespace spindrift::study
