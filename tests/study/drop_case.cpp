// Drops of particles in free fall: how they oscillate and become round.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <spindrift/sim/water_sim.h>

#include "cases.h"
#include "particle_choices.h"
#include "ticks.h"

namespace spindrift::study {
namespace {

constexpr double kSpacing_m = 1e-3;
constexpr double kTension_npm = 0.0728;
constexpr double kDensity_kgpm3 = 1000.0;
/// Drop of a cube of so many particles per side, in a box of two and a half such sides.
constexpr double kBoxOverCube = 2.5;

using Point = std::array<double, 3>;

core::Scene dropScene(core::PressureSolver solver, std::uint32_t across_count) {
  core::Scene scene;
  scene.name = "drop";
  scene.gravity_mps2 = 0.0;
  scene.tick_rate_hz = 250.0;
  scene.particles.emplace();
  core::ParticleScene& p = *scene.particles;
  p.solver = solver;
  p.count = across_count * across_count * across_count;
  p.layers_count = across_count;
  p.box_side_m = kBoxOverCube * across_count * kSpacing_m;
  p.fill_x_ratio = p.fill_z_ratio = 1 / kBoxOverCube;
  p.headroom_m = p.box_side_m - across_count * kSpacing_m;
  p.boundary_x = p.boundary_z = core::Boundary::kWall;
  p.sound_speed_mps = 3.0;
  p.max_speed_mps = 0.5;
  p.viscosity_pas = 0.005;
  p.surface_tension_npm = kTension_npm;
  return scene;
}

/// Puts the particles on the points of a lattice that are nearest to the middle of the box, by a norm, at rest.
template <typename Norm>
void shape(sim::WaterSim& water, const Norm& norm) {
  const sim::ParticleLayout& l = *water.derived().particles;
  const int reach = static_cast<int>((l.max_m[0] - l.min_m[0]) / l.spacing_m / 2);
  std::vector<std::pair<double, Point>> points;
  for (int x = -reach; x < reach; ++x) {
    for (int y = -reach; y < reach; ++y) {
      for (int z = -reach; z < reach; ++z) {
        // Off the middle, so that no two norms are equal and the choice does not depend on the order.
        const Point p{(x + 0.501) * l.spacing_m, (y + 0.5003) * l.spacing_m, (z + 0.4993) * l.spacing_m};
        points.emplace_back(norm(p), p);
      }
    }
  }
  std::ranges::sort(points);
  sim::StateCopy state = water.copyState();
  for (std::size_t i = 0; i < water.particleCount(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double middle_m = 0.5 * (l.min_m[axis] + l.max_m[axis]);
      state.position[4 * i + axis] = static_cast<float>(middle_m + points[i].second[axis]);
      state.velocity[4 * i + axis] = 0.0f;
    }
  }
  water.setState(state);
}

/// Stretches the drop along x, keeps its volume, and stops it.
void stretch(sim::WaterSim& water, double ratio) {
  const sim::ParticleLayout& l = *water.derived().particles;
  sim::StateCopy state = water.copyState();
  for (std::size_t i = 0; i < state.position.size(); ++i) {
    const std::size_t axis = i % 4;
    if (axis == 3) continue;
    const double middle_m = 0.5 * (l.min_m[axis] + l.max_m[axis]);
    const double factor = axis == 0 ? ratio : 1 / std::sqrt(ratio);
    state.position[i] = static_cast<float>(middle_m + factor * (state.position[i] - middle_m));
    state.velocity[i] = 0.0f;
  }
  water.setState(state);
}

struct Moments {
  Point squares_m2{};          ///< mean squares of the distances from the middle of the drop, along each axis
  std::size_t away_count = 0;  ///< particles that have left the drop
  Point momentum_mps{};        ///< mean velocity

  /// 0 for a sphere; about 1 % for one that is 1 % longer along x.
  [[nodiscard]] double elongation() const {
    return (squares_m2[0] - 0.5 * (squares_m2[1] + squares_m2[2])) / (squares_m2[0] + squares_m2[1] + squares_m2[2]);
  }
};

double radiusOf(const sim::WaterSim& water) {
  const double volume_m3 = water.particleCount() * std::pow(water.derived().particles->spacing_m, 3);
  return std::cbrt(3 * volume_m3 / (4 * std::numbers::pi));
}

Moments momentsOf(sim::WaterSim& water) {
  constexpr double kReach = 2.0;  // radii
  const sim::StateCopy state = water.copyState();
  const std::size_t count = water.particleCount();
  Moments out;
  Point middle_m{};
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      middle_m[axis] += state.position[4 * i + axis] / static_cast<double>(count);
      out.momentum_mps[axis] += state.velocity[4 * i + axis] / static_cast<double>(count);
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    Point r_m;
    for (std::size_t axis = 0; axis < 3; ++axis) r_m[axis] = state.position[4 * i + axis] - middle_m[axis];
    if (std::hypot(r_m[0], r_m[1], r_m[2]) > kReach * radiusOf(water)) {
      ++out.away_count;
      continue;
    }
    for (std::size_t axis = 0; axis < 3; ++axis)
      out.squares_m2[axis] += r_m[axis] * r_m[axis] / static_cast<double>(count);
  }
  return out;
}

struct Pressure {
  double whole_pa = 0.0;   ///< of all forces between particles
  double solver_pa = 0.0;  ///< of the equation of state alone
};

/// Mean pressure inside a drop at rest, in the weakly compressible solver, by the virial of the forces that
/// shaders/sph/force.comp adds up: sum of r F / 6 over the pairs of the particles farther than two supports from the
/// surface, over their volume. The pressure of the equation of state is not that of the water: it also carries the
/// attraction of the particles.
Pressure pressureInside(const sim::WaterSim& water, const sim::StateCopy& state) {
  const sim::ParticleLayout& l = *water.derived().particles;
  const shared::SimUniforms& u = water.derived().uniforms;
  const double H = l.support_radius_m;
  const double slope_pm4 = 210 / (std::numbers::pi * std::pow(H, 4));  // -(dW/dr) / (q (1 - q)^3)
  const std::size_t count = water.particleCount();
  const auto between = [&](std::size_t i, std::size_t j) {
    return Point{static_cast<double>(state.position[4 * i]) - state.position[4 * j],
                 static_cast<double>(state.position[4 * i + 1]) - state.position[4 * j + 1],
                 static_cast<double>(state.position[4 * i + 2]) - state.position[4 * j + 2]};
  };
  Point middle_m{};
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      middle_m[axis] += state.position[4 * i + axis] / static_cast<double>(count);
  }
  std::vector<Point> emptiness_m(count);  // SURFACE_GRADIENT
  std::vector<double> push(count);        // p / rho^2
  std::vector<std::size_t> inner;
  double inner_m3 = 0.0;
  double pressure_pa = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const double rho = state.density_kgpm3[i];
    const double p_pa = std::max(u.stiffness_m2ps2 * (rho - u.rest_density_kgpm3), 0.0);
    push[i] = p_pa / (rho * rho);
    const double out_m = std::hypot(state.position[4 * i] - middle_m[0], state.position[4 * i + 1] - middle_m[1],
                                    state.position[4 * i + 2] - middle_m[2]);
    if (out_m < radiusOf(water) - 2 * H) {
      inner.push_back(i);
      inner_m3 += u.mass_kg / rho;
      pressure_pa += p_pa;
    }
    for (std::size_t j = 0; j < count; ++j) {
      const Point r = between(i, j);
      const double rest = std::max(1 - std::hypot(r[0], r[1], r[2]) / H, 0.0);
      for (std::size_t axis = 0; axis < 3; ++axis) emptiness_m[i][axis] += rest * rest * rest * r[axis];
    }
  }
  double virial_j = 0.0;
  for (const std::size_t i : inner) {
    for (std::size_t j = 0; j < count; ++j) {
      const Point r = between(i, j);
      const double r2 = r[0] * r[0] + r[1] * r[1] + r[2] * r[2];
      const double q = std::sqrt(r2) / H;
      if (i == j || q >= 1) continue;
      const double rest = 1 - q;
      double along = 0.0;  // r times the difference of the gradients
      for (std::size_t axis = 0; axis < 3; ++axis) along += r[axis] * (emptiness_m[i][axis] - emptiness_m[j][axis]);
      virial_j += u.mass_kg * (u.mass_kg * (push[i] + push[j]) * slope_pm4 * q * rest * rest * rest * q * H -
                               rest * rest * (u.tension_area_ps2 * along * (rest - 3 * q) + u.tension_pull_ps2 * r2));
    }
  }
  return {virial_j / (6 * inner_m3), pressure_pa / static_cast<double>(inner.size())};
}

/// a cos(w t) exp(-d t) + b sin(w t) exp(-d t) + c, fitted by least squares over w and d on a grid.
struct Oscillation {
  double omega_radps = 0.0;
  double decay_ps = 0.0;
};

/// Squared rest of the best a, b, c for w and d.
double restOf(const std::vector<double>& series, double interval_s, double omega_radps, double decay_ps) {
  // Gram-Schmidt over the three functions.
  std::array<std::vector<double>, 3> basis;
  for (std::size_t n = 0; n < series.size(); ++n) {
    const double t = static_cast<double>(n) * interval_s;
    const double fade = std::exp(-decay_ps * t);
    basis[0].push_back(fade * std::cos(omega_radps * t));
    basis[1].push_back(fade * std::sin(omega_radps * t));
    basis[2].push_back(1.0);
  }
  std::vector<double> rest = series;
  const auto dot = [](const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0.0;
    for (std::size_t n = 0; n < a.size(); ++n) sum += a[n] * b[n];
    return sum;
  };
  const auto remove = [&](std::vector<double>& from, const std::vector<double>& unit) {
    const double share = dot(from, unit) / std::max(dot(unit, unit), 1e-300);
    for (std::size_t n = 0; n < from.size(); ++n) from[n] -= share * unit[n];
  };
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t j = 0; j < k; ++j) remove(basis[k], basis[j]);
    remove(rest, basis[k]);
  }
  return dot(rest, rest);
}

Oscillation fitOscillation(const std::vector<double>& series, double interval_s, double expected_radps) {
  Oscillation best;
  double least = std::numeric_limits<double>::max();
  for (int w = 40; w <= 200; ++w) {
    for (int d = 0; d <= 50; ++d) {
      const Oscillation tried{0.01 * w * expected_radps, 0.02 * d * expected_radps};
      const double rest = restOf(series, interval_s, tried.omega_radps, tried.decay_ps);
      if (rest >= least) continue;
      least = rest;
      best = tried;
    }
  }
  return best;
}

/// Adds the mean of the pressure inside over half a period. The position-based solver has multipliers instead of a
/// pressure.
core::Result<void> addPressure(sim::WaterSim& water, double period_s, const std::string& name, std::vector<Row>& rows) {
  if (water.scene().particles->solver != core::PressureSolver::kWeaklyCompressible) return {};
  Pressure mean;
  int count = 0;
  const auto look = [&] {
    const Pressure seen = pressureInside(water, water.copyState());
    ++count;
    mean.whole_pa += (seen.whole_pa - mean.whole_pa) / count;
    mean.solver_pa += (seen.solver_pa - mean.solver_pa) / count;
  };
  if (auto done = runTo(water, water.time_s() + 0.5 * period_s, look); !done) return done.error();
  const double laplace_pa = 2 * kTension_npm / radiusOf(water);
  rows.push_back({name, "Pa", mean.whole_pa, laplace_pa, Tolerance::kNone, 0.0,
                  "2 sigma / R (Laplace); decision 133 says why it is only reported"});
  rows.push_back({name + ": of the equation of state", "Pa", mean.solver_pa, laplace_pa, Tolerance::kNone, 0.0,
                  "2 sigma / R; it carries the attraction, too"});
  return {};
}

}  // namespace

Outcome drops(gpu::Context& ctx, bool quick) {
  std::vector<Row> rows;
  Figure figure{.name = "drop",
                .title = "A drop that was stretched by 15 %",
                .x_label = "t omega / 2 pi [-], omega of Rayleigh",
                .y_label = "elongation [-]",
                .curves = {}};
  for (const core::PressureSolver solver : kSolvers) {
    for (const std::uint32_t across_count : {12u, 16u}) {
      if (quick && across_count > 12) continue;
      auto made = sim::WaterSim::create(ctx, dropScene(solver, across_count));
      if (!made) return made.error();
      sim::WaterSim& water = **made;
      const double radius_m = radiusOf(water);
      const double rayleigh_radps = std::sqrt(8 * kTension_npm / (kDensity_kgpm3 * std::pow(radius_m, 3)));
      const double period_s = 2 * std::numbers::pi / rayleigh_radps;
      const std::string name = fmt::format("{}, drop with a radius of {:.1f} spacings: ", nameOf(solver),
                                           radius_m / water.derived().particles->spacing_m);
      // A block with sides 2:1:1 becomes a drop.
      shape(water, [](const Point& p) { return std::max({std::abs(p[0]) / 2, std::abs(p[1]), std::abs(p[2])}); });
      const double block = momentsOf(water).elongation();
      if (auto done = runTo(water, 2.5 * period_s); !done) return done.error();
      const Moments round = momentsOf(water);
      rows.push_back({name + "elongation of what was a block, over that of the block", "",
                      std::abs(round.elongation()) / block, 0.2, Tolerance::kAtMost, 0.0, "a sphere"});
      if (auto done = addPressure(water, period_s, name + "pressure inside, what was a block", rows); !done)
        return done.error();
      shape(water, [](const Point& p) { return std::hypot(p[0], p[1], p[2]); });
      if (auto done = runTo(water, water.time_s() + period_s); !done) return done.error();
      if (auto done = addPressure(water, period_s, name + "pressure inside, at rest from the start", rows); !done)
        return done.error();
      stretch(water, 1.15);
      std::vector<double> series{momentsOf(water).elongation()};
      const double start_s = water.time_s();
      const auto watch = [&] { series.push_back(momentsOf(water).elongation()); };
      if (auto done = runTo(water, start_s + 1.5 * period_s, watch); !done) return done.error();
      const double interval_s = water.derived().tick_s;
      const Oscillation found = fitOscillation(series, interval_s, rayleigh_radps);
      rows.push_back({name + "frequency after it was stretched by 15 %", "rad/s", found.omega_radps, rayleigh_radps,
                      Tolerance::kRelative, 0.2, "omega^2 = 8 sigma / (rho R^3) (Rayleigh 1879)"});
      rows.push_back({name + "decay", "1/s", found.decay_ps,
                      5 * water.scene().particles->viscosity_pas / kDensity_kgpm3 / (radius_m * radius_m),
                      Tolerance::kNone, 0.0, "5 nu / R^2 (Lamb 1932); the rest is the scheme's own"});
      const Moments end = momentsOf(water);
      rows.push_back({name + "particles that left", "%",
                      100.0 * static_cast<double>(end.away_count) / water.particleCount(), 1.0, Tolerance::kAtMost, 0.0,
                      "none"});
      const double ripple_mps = std::sqrt(kTension_npm / (kDensity_kgpm3 * radius_m));
      rows.push_back({name + "speed of the middle over sqrt(sigma / (rho R))", "",
                      std::hypot(end.momentum_mps[0], end.momentum_mps[1], end.momentum_mps[2]) / ripple_mps, 0.01,
                      Tolerance::kAtMost, 0.0, "momentum stays, but what has left meets the walls"});
      Figure::Curve curve{fmt::format("{}, R = {:.1f} s", nameOf(solver), radius_m / kSpacing_m), {}, true};
      for (std::size_t n = 0; n < series.size(); ++n)
        curve.points.emplace_back(static_cast<double>(n) * interval_s / period_s, series[n]);
      figure.curves.push_back(std::move(curve));
    }
  }
  return CaseResult{std::move(rows), {std::move(figure)}};
}

}  // namespace spindrift::study
