// The Taylor-Green vortex in a box that is periodic in all directions: u = U sin(kx) cos(kz), w = -U cos(kx) sin(kz), k
// = 2 pi / L, decays like exp(-2 nu k^2 t) = exp(-8 pi^2 t / Re) for L = U = 1.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include <spindrift/sim/water_sim.h>

#include "cases.h"
#include "particle_choices.h"
#include "ticks.h"

namespace spindrift::study {
namespace {

constexpr double kReynolds = 100.0;
constexpr double k_pm = 2 * std::numbers::pi;  // L = 1 m, U = 1 m/s
/// In the first second the starting lattice becomes a liquid, which slows the vortex once; the rate is measured after
/// that.
constexpr double kFirst_s = 1.0;
constexpr double kLast_s = 2.0;

/// Support radius over spacing. More neighbours reproduce shear better, until particles begin to pair; with the
/// Wendland kernel they never do (Dehnen & Aly 2012).
double supportRatio(core::KernelSet set) {
  switch (set) {
    case core::KernelSet::kMuller:
      return 2.0;
    case core::KernelSet::kCubicSpline:
      return 2.2;
    case core::KernelSet::kWendlandC2:
      break;
  }
  return 2.4;
}

core::Scene vortexScene(core::PressureSolver solver, core::KernelSet set, std::uint32_t across_count) {
  core::Scene scene;
  scene.name = "vortex";
  scene.gravity_mps2 = 0.0;
  scene.particles.emplace();
  core::ParticleScene& p = *scene.particles;
  p.solver = solver;
  p.kernel_set = set;
  p.support_ratio = supportRatio(set);
  p.layers_count = 7;
  p.count = across_count * across_count * 7;
  p.box_side_m = 1.0;
  p.boundary_x = p.boundary_z = core::Boundary::kPeriodic;
  p.periodic_y = true;
  // 2 % less water than the box holds at rest. Pressure never pulls, and this flow must not need it to; under pressure
  // the particles would lock into a lattice that resists shear.
  p.fill_density_ratio = 0.98;
  p.sound_speed_mps = 10.0;
  p.max_speed_mps = 2.0;
  p.viscosity_pas = p.rest_density_kgpm3 / kReynolds;
  return scene;
}

double rootMeanSquareSpeed(const sim::StateCopy& state) {
  double squares = 0.0;
  for (std::size_t i = 0; i < state.velocity.size(); i += 4)
    for (std::size_t axis = 0; axis < 3; ++axis) squares += std::pow(state.velocity[i + axis], 2);
  return std::sqrt(squares / static_cast<double>(state.velocity.size() / 4));
}

/// Mean distance to the nearest neighbour, over every seventh particle.
double nearestNeighbour(const sim::WaterSim& water, const sim::StateCopy& state) {
  const sim::ParticleLayout& l = *water.derived().particles;
  const std::size_t n = state.position.size() / 4;
  double sum_m = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < n; i += 7, ++count) {
    double nearest2 = std::numeric_limits<double>::max();
    for (std::size_t j = 0; j < n; ++j) {
      if (j == i) continue;
      double r2 = 0.0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double side_m = l.max_m[axis] - l.min_m[axis];
        double r_m = static_cast<double>(state.position[4 * i + axis]) - state.position[4 * j + axis];
        r_m -= side_m * std::round(r_m / side_m);
        r2 += r_m * r_m;
      }
      nearest2 = std::min(nearest2, r2);
    }
    sum_m += std::sqrt(nearest2);
  }
  return sum_m / count;
}

struct Decay {
  double late_rate_ratio = 0.0;  ///< rate of decay over 2 nu k^2, between kFirst_s and kLast_s
  double first_speed = 0.0;      ///< speed at kFirst_s over the theoretical one
  double neighbour_gap = 0.0;    ///< nearest neighbour over the spacing at the end
};

core::Result<Decay> decay(gpu::Context& ctx, const core::Scene& scene) {
  auto made = sim::WaterSim::create(ctx, scene);
  if (!made) return made.error();
  sim::WaterSim& water = **made;
  sim::StateCopy state = water.copyState();
  for (std::size_t i = 0; i < state.position.size(); i += 4) {
    const double x = k_pm * state.position[i];
    const double z = k_pm * state.position[i + 2];
    state.velocity[i] = static_cast<float>(std::sin(x) * std::cos(z));
    state.velocity[i + 1] = 0.0f;
    state.velocity[i + 2] = static_cast<float>(-std::cos(x) * std::sin(z));
  }
  water.setState(state);
  const double start_mps = rootMeanSquareSpeed(state);
  const double rate_ps = 2 * k_pm * k_pm / kReynolds;
  if (auto done = runTo(water, kFirst_s); !done) return done.error();
  const double first_mps = rootMeanSquareSpeed(water.copyState());
  if (auto done = runTo(water, kLast_s); !done) return done.error();
  const sim::StateCopy last = water.copyState();
  Decay out;
  out.late_rate_ratio = std::log(first_mps / rootMeanSquareSpeed(last)) / (kLast_s - kFirst_s) / rate_ps;
  out.first_speed = first_mps / (start_mps * std::exp(-rate_ps * kFirst_s));
  out.neighbour_gap = nearestNeighbour(water, last) / water.derived().particles->spacing_m;
  return out;
}

}  // namespace

Outcome taylorGreen(gpu::Context& ctx, bool quick) {
  std::vector<Row> rows;
  for (const core::PressureSolver solver : kSolvers) {
    for (const core::KernelSet set : kKernelSets) {
      // The quick table uses the default kernel set of each solver.
      if (quick && set != core::KernelSet::kWendlandC2) continue;
      const std::uint32_t across_count = quick ? 26 : 40;
      auto found = decay(ctx, vortexScene(solver, set, across_count));
      if (!found) return found.error();
      const std::string name =
          fmt::format("{}, {}, {}^2 particles, Re = 100: ", nameOf(solver), nameOf(set), across_count);
      rows.push_back({name + "rate of decay, t = 1 to 2, over 8 pi^2 / Re", "", found->late_rate_ratio, 1.0,
                      Tolerance::kRelative, 0.1, "Taylor & Green 1937: speeds fall like exp(-8 pi^2 t / Re)"});
      rows.push_back({name + "mean distance to the nearest neighbour over the spacing", "", found->neighbour_gap, 0.65,
                      Tolerance::kAtLeast, 0.0, "no clumping: 1 in a lattice, 0.55 where places are random"});
    }
  }
  if (quick) return CaseResult{std::move(rows), {}};
  for (const std::uint32_t across_count : {20u, 40u, 80u}) {
    auto found =
        decay(ctx, vortexScene(core::PressureSolver::kWeaklyCompressible, core::KernelSet::kWendlandC2, across_count));
    if (!found) return found.error();
    rows.push_back({fmt::format("{}^2 particles: speed lost while the lattice becomes a liquid", across_count), "%",
                    100 * (1 - found->first_speed), 0.0, Tolerance::kNone, 0.0,
                    "speed at t = 1 over theory's; to see it fall"});
  }
  return CaseResult{std::move(rows), {}};
}

}  // namespace spindrift::study
