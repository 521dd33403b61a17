// What nonlinear shallow water conserves: momentum through bores; energy does not grow.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <fmt/format.h>

#include "cases.h"
#include "shallow_water.h"
#include "ticks.h"

namespace spindrift::study {
namespace {

using std::numbers::pi;

constexpr double kGravity_mps2 = 9.81;

/// Relative change of the momentum of periodic water with two bores in it.
core::Result<double> momentumDrift(gpu::Context& ctx, int step_count) {
  constexpr std::uint32_t kCells = 400;
  constexpr double kCell_m = 0.05;
  core::Scene scene = shallowChannel(kCells, kCell_m, 1.0, 0.5);
  makePeriodic(scene);
  scene.tick_rate_hz = 6.0 / (0.4 * kCell_m);  // no water runs faster than 6 m/s
  auto water = sim::WaterSim::create(ctx, scene);
  if (!water) return water.error();
  const double length_m = kCells * kCell_m;
  setShallowState(
      **water,
      [&](double x, double) {
        const double at_m = x + length_m / 2;
        return std::abs(at_m - 6) < 2 ? 0.5 : std::abs(at_m - 14) < 2 ? -0.3 : 0.0;
      },
      [&](double x, double) { return 0.8 * std::pow(std::sin(2 * pi * x / length_m), 2); });
  const auto momentum = [&] {
    const sim::StateCopy state = (*water)->copyState();
    double sum = 0.0;
    for (std::size_t i = 0; i < kCells; ++i) {
      const double water_m = 1.0 + 0.5 * (state.elevation_m[i] + state.elevation_m[(i + 1) % kCells]);
      sum += water_m * static_cast<double>(state.flow_m2ps[4 * i]);
    }
    return sum;
  };
  if (auto done = run(**water, 1); !done) return done.error();
  const double start = momentum();
  if (auto done = run(**water, step_count); !done) return done.error();
  return momentum() / start - 1;
}

/// A random field of waves, periodic over the unit square, with values up to 1.
class Chop {
 public:
  explicit Chop(std::mt19937& random) {
    std::uniform_real_distribution<double> phase(0.0, 2 * pi);
    std::normal_distribution<double> height;
    for (int kx = 0; kx <= kShortest; ++kx) {
      for (int kz = -kShortest; kz <= kShortest; ++kz) {
        if (kx == 0 && kz <= 0) continue;
        const double weight = std::exp(-(kx * kx + kz * kz) / 27.0);
        modes_.push_back({2 * pi * kx, 2 * pi * kz, phase(random), weight * height(random)});
      }
    }
    double highest = 0.0;
    for (int i = 0; i < 64 * 64; ++i) highest = std::max(highest, std::abs(at(i % 64 / 64.0, i / 64 / 64.0)));
    for (Mode& mode : modes_) mode.height /= highest;
  }
  [[nodiscard]] double at(double x, double z) const {
    double sum = 0.0;
    for (const Mode& mode : modes_) sum += mode.height * std::cos(mode.kx * x + mode.kz * z + mode.phase);
    return sum;
  }

 private:
  static constexpr int kShortest = 9;
  struct Mode {
    double kx, kz, phase, height;
  };
  std::vector<Mode> modes_;
};

struct Energy {
  double largest;  ///< over that of the start
  double at_end;
};

/// Energy of chop in periodic water, with islands or without.
core::Result<Energy> chopEnergy(gpu::Context& ctx, bool islands, int step_count) {
  constexpr std::uint32_t kCells = 64;
  constexpr double kCell_m = 0.1;
  constexpr double kHeight_m = 0.35;
  std::mt19937 random(3);
  const Chop level(random), u(random), w(random), ground(random);
  const double depth_m = islands ? 0.6 : 1.0;
  const double side_m = kCells * kCell_m;
  const auto of = [&](const Chop& field, double x, double z) { return field.at(x / side_m + 0.5, z / side_m + 0.5); };
  core::Scene scene = shallowScene(kCells, kCell_m, depth_m, 0.5);
  makePeriodic(scene);
  if (islands) setBed(scene, [&](double x, double z) { return of(ground, x, z) > 0.3 ? -0.4 : depth_m; });
  scene.tick_rate_hz = (std::sqrt(kGravity_mps2 * (1 + kHeight_m)) + 1.0) / (0.5 * kCell_m);
  auto water = sim::WaterSim::create(ctx, scene);
  if (!water) return water.error();
  setShallowState(
      **water, [&](double x, double z) { return kHeight_m * of(level, x, z); },
      [&](double x, double z) { return of(u, x, z); }, [&](double x, double z) { return of(w, x, z); });
  const std::vector<double> ground_m = groundDepths(scene, *(*water)->derived().wave);
  const auto energy = [&] {
    const sim::StateCopy state = (*water)->copyState();
    const auto water_m = [&](std::size_t i) { return std::max(state.elevation_m[i] + ground_m[i], 0.0); };
    double sum = 0.0;
    for (std::size_t i = 0; i < ground_m.size(); ++i) {
      const double here_m = water_m(i);
      // Dry ground has none; water on land has that of its height over the still water.
      if (here_m > 0)
        sum += 0.5 * kGravity_mps2 * (std::pow(state.elevation_m[i], 2) - std::pow(std::min(ground_m[i], 0.0), 2));
      const std::array<std::size_t, 2> next = {i - i % kCells + (i + 1) % kCells, (i + kCells) % ground_m.size()};
      for (std::size_t axis = 0; axis < 2; ++axis) {
        const double velocity_mps = static_cast<double>(state.flow_m2ps[4 * i + axis]);
        sum += 0.25 * (here_m + water_m(next[axis])) * velocity_mps * velocity_mps;
      }
    }
    return sum;
  };
  const double start = energy();
  Energy out{0.0, 0.0};
  int count = 0;
  auto done = run(**water, step_count, [&] {
    if (++count % 5 != 0) return;
    out.at_end = energy() / start;
    out.largest = std::max(out.largest, out.at_end);
  });
  if (!done) return done.error();
  return out;
}

}  // namespace

Outcome momentumAndEnergy(gpu::Context& ctx, bool quick) {
  std::vector<Row> rows;
  const int step_count = 3000;
  const auto drift = momentumDrift(ctx, step_count);
  if (!drift) return drift.error();
  rows.push_back({fmt::format("bores in periodic water, {} steps: change of the momentum", step_count), "", *drift, 0.0,
                  Tolerance::kAbsolute, 2e-4, "conserved"});
  for (const bool islands : {false, true}) {
    const int chop_steps = quick ? 500 : 1500;
    const auto energy = chopEnergy(ctx, islands, chop_steps);
    if (!energy) return energy.error();
    const std::string name = fmt::format("chop of 0.35 m{}, {} steps: ", islands ? " between islands" : "", chop_steps);
    rows.push_back({name + "largest energy / that of the start", "", energy->largest, 1.0, Tolerance::kAtMost, 0.0,
                    "bores and friction only take energy"});
    rows.push_back({name + "energy left", "", energy->at_end, 0.0, Tolerance::kNone, 0.0, "reported"});
  }
  return CaseResult{std::move(rows), {}};
}

}  // namespace spindrift::study
