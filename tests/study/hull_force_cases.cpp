// Forces of the water on boats that another program moves: buoyancy, added mass and damping of heave, waves on a hull
// held fast. The reference of heave and waves is linear theory of the model's own hull, a distribution of displaced
// volume w per metre of draught over the surface, which lets the surface under it rise and fall (decision 144): phi_tt
// + kappa phi_t = -Omega^2(k) phi + w (D_tt + kappa D_t), D the draught, and the force rho g integral of w phi.
#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <vector>

#include <fmt/format.h>
#include <shared/boats.h>

#include <spindrift/study/hull_pressure.h>

#include "cases.h"
#include "ticks.h"
#include "wave_resistance.h"

namespace spindrift::study {
namespace {

using std::numbers::pi;
using Complex = std::complex<double>;

constexpr double kDensity_kgpm3 = 1000.0;
constexpr double kCell_m = 0.15;

/// A basin of 128 x 128 cells with periodic sides, and a boat in its middle.
core::Scene hullBasin(const core::Boat& boat, double depth_m, core::Dispersion dispersion, double damping_per_s) {
  core::Scene scene;
  scene.name = "hull basin";
  scene.wave.emplace();
  scene.wave->resolution_count = 128;
  scene.wave->side_m = 128 * kCell_m;
  scene.wave->depth_m = depth_m;
  scene.wave->damping_per_s = damping_per_s;
  scene.wave->dispersion = dispersion;
  setBoundaries(*scene.wave, core::WaveBoundary::kPeriodic);
  scene.boats.emplace();
  scene.boats->boats = {boat};
  return scene;
}

/// Calls pose(time_s) before each tick and force(time_s, force) with what the water did in it, at the time for which it
/// holds: the mean of the starts of the wave steps.
core::Result<void> runMoved(gpu::Context& ctx, sim::WaterSim& water, int tick_count,
                            const std::function<sim::HullMotion(double)>& pose,
                            const std::function<void(double, const sim::HullForce&)>& force) {
  const double tick_s = water.derived().tick_s;
  const double lag_s = 0.5 * (tick_s + water.derived().wave->dt_s);
  for (int k = 0; k < tick_count; ++k) {
    if (auto placed = water.moveBoat(pose(water.time_s())); !placed) return placed;
    if (auto done = tick(water); !done) return done;
    ctx.finish();
    for (const sim::HullForces& forces : water.takeHullForces()) force(water.time_s() - lag_s, forces.hulls.front());
  }
  return {};
}

/// Amplitude of a value that oscillates with omega, by its product with exp(-i omega t) over whole periods.
class Oscillation {
 public:
  explicit Oscillation(double omega_radps) : omega_radps_(omega_radps) {}
  void add(double time_s, double value) {
    sum_ += value * std::exp(Complex(0.0, -omega_radps_ * time_s));
    ++count_;
  }
  [[nodiscard]] Complex amplitude() const { return 2.0 * sum_ / static_cast<double>(count_); }

 private:
  double omega_radps_;
  Complex sum_;
  int count_ = 0;
};

/// Force over the draught's amplitude, without buoyancy, of a hull that heaves in a square basin with periodic sides.
/// [N/m]
Complex heaveForce(const HullPressure& hull, double draught_m, const LinearWater& water, double omega_radps,
                   double side_m, double damping_per_s) {
  const double per_rad = 2 * pi / side_m;
  const Complex drive(-omega_radps * omega_radps, omega_radps * damping_per_s);
  Complex sum;
  constexpr int kModes = 64;  // half the cells
  for (int i = -kModes; i <= kModes; ++i) {
    for (int j = -kModes; j <= kModes; ++j) {
      const double w_m2 = hull.spectrum_m3(i * per_rad, j * per_rad) / draught_m;
      sum += w_m2 * w_m2 * drive / (water.omega2(per_rad * std::hypot(i, j)) + drive);
    }
  }
  return kDensity_kgpm3 * water.gravity_mps2 * sum / (side_m * side_m);
}

/// Added mass [kg] and damping [N s/m] of a force over the draught's amplitude.
struct Heave {
  double added_mass_kg, damping_nspm;
};
Heave heaveOf(Complex force_npm, double omega_radps) {
  return {-force_npm.real() / (omega_radps * omega_radps), force_npm.imag() / omega_radps};
}

void addHeave(const std::string& what, Complex measured_npm, Complex expected_npm, double omega_radps,
              const std::string& source, std::vector<Row>& rows) {
  constexpr double kShare = 0.01;  // of the whole force
  const Heave measured = heaveOf(measured_npm, omega_radps), expected = heaveOf(expected_npm, omega_radps);
  const double force_npm = std::abs(expected_npm);
  rows.push_back({what + ": added mass", "kg", measured.added_mass_kg, expected.added_mass_kg, Tolerance::kAbsolute,
                  kShare * force_npm / (omega_radps * omega_radps), source});
  rows.push_back({what + ": damping", "N s/m", measured.damping_nspm, expected.damping_nspm, Tolerance::kAbsolute,
                  kShare * force_npm / omega_radps, source});
}

/// A hull that heaves by 2 cm about a draught of 0.2 m.
core::Result<Complex> measureHeave(gpu::Context& ctx, sim::WaterSim& water, const core::Boat& boat, double omega_radps,
                                   int settling_ticks, int measured_ticks) {
  constexpr double kHeave_m = 0.02, kDraught_m = 0.2;
  const auto pose = [&](double t) {
    return sim::HullMotion{.boat_id = 1,
                           .y_m = boat.height_m / 2 - kDraught_m - kHeave_m * std::cos(omega_radps * t),
                           .velocity_y_mps = kHeave_m * omega_radps * std::sin(omega_radps * t)};
  };
  if (auto done = runMoved(ctx, water, settling_ticks, pose, [](double, const sim::HullForce&) {}); !done)
    return done.error();
  Oscillation force(omega_radps);
  if (auto done = runMoved(ctx, water, measured_ticks, pose,
                           [&](double t, const sim::HullForce& f) { force.add(t, f.dynamic.force_n[1]); });
      !done)
    return done.error();
  return force.amplitude() / kHeave_m;
}

}  // namespace

Outcome hullBuoyancy(gpu::Context& ctx, bool /*quick*/) {
  const core::Boat boat{.length_m = 3.0, .beam_m = 1.2, .height_m = 0.8, .density_ratio = 0.25};
  auto made = sim::WaterSim::create(ctx, hullBasin(boat, 1.5, core::Dispersion::kNone, 1.0));
  if (!made) return made.error();
  std::vector<Row> rows;
  const double area_npm = kDensity_kgpm3 * 9.81 * boat.length_m * boat.beam_m;
  sim::HullForce force;
  const auto hold = [&](int tick_count, const sim::HullMotion& pose) {
    return runMoved(
        ctx, **made, tick_count, [&](double) { return pose; }, [&](double, const sim::HullForce& f) { force = f; });
  };
  for (const double draught_m : {0.05, 0.2, 0.5, 0.75, 1.1}) {
    if (auto done = hold(1, {.boat_id = 1, .y_m = 0.4 - draught_m}); !done) return done.error();
    rows.push_back({fmt::format("buoyancy of a hull of 0.8 m at a draught of {} m", draught_m), "N",
                    force.hydrostatic.force_n[1], area_npm * std::min(draught_m, boat.height_m), Tolerance::kRelative,
                    0.002,
                    "Archimedes: length, beam and draught, at most its height; tolerance: the shape is cut off"});
  }
  // Wall-sided: second moment of the area by the hull's shape, less the lever of the buoyancy under the centre.
  constexpr double kHeel_rad = 0.03, kDraught_m = 0.3;
  if (auto done = hold(1, {.boat_id = 1, .y_m = 0.4 - kDraught_m, .roll_rad = kHeel_rad}); !done) return done.error();
  const double second_m2 = std::pow(boat.beam_m / 2, 2) * 0.30635 / 0.9064;
  const double lever_m2 = kDraught_m * (boat.height_m - kDraught_m) / 2;
  rows.push_back(
      {"moment that rights a hull heeled by 0.03 rad", "N m", -force.hydrostatic.moment_nm[0],
       area_npm * (second_m2 - lever_m2) * kHeel_rad, Tolerance::kRelative, 0.03,
       "rho g V (metacentre - centre); the shape's second moment, 1.4 % more than a box's; tolerance: cells"});
  if (auto done = hold(900, {.boat_id = 1, .y_m = 0.4 - kDraught_m}); !done) return done.error();
  const double raised_m = boat.length_m * boat.beam_m * kDraught_m / std::pow(128 * kCell_m, 2);
  rows.push_back({"dynamic force on a hull held still for 15 s", "N", force.dynamic.force_n[1], area_npm * raised_m,
                  Tolerance::kAbsolute, 0.002 * area_npm * kDraught_m,
                  "the basin's level is higher by what is displaced; tolerance: 0.2 % of the buoyancy"});
  return CaseResult{std::move(rows), {}};
}

Outcome hullHeave(gpu::Context& ctx, bool quick) {
  std::vector<Row> rows;
  // A box across a channel without dispersion: each side gets half of what is displaced.
  {
    constexpr double kDepth_m = 0.5, kLength_m = 1.5;
    const core::Boat box{.length_m = kLength_m, .beam_m = 40.0, .height_m = 0.8, .density_ratio = 0.25};
    core::Scene scene = hullBasin(box, kDepth_m, core::Dispersion::kNone, 0.0);
    scene.wave->resolution_count = 512;
    scene.wave->side_m = 512 * kCell_m;
    scene.wave->width_m = 4 * kCell_m;
    const double width_m = 4 * kCell_m;
    const double c_mps = std::sqrt(9.81 * kDepth_m);
    const HullPressure hull = hullPressure(box, kCell_m);
    for (const double frequency_hz : quick ? std::vector{0.5} : std::vector{0.3, 0.5}) {
      const double omega = 2 * pi * frequency_hz, k = omega / c_mps;
      auto made = sim::WaterSim::create(ctx, scene);
      if (!made) return made.error();
      const int period = static_cast<int>(std::lround(60.0 / frequency_hz));
      auto measured = measureHeave(ctx, **made, box, omega, 2 * period, 2 * period);
      if (!measured) return measured.error();
      // F / D = rho g width iw/(2c) sum over pairs of w(x) w(y) exp(-ik|x - y|), by sums over short parts.
      constexpr int kParts = 400;
      const double part_m = 2.0 * double{HULL_REACH} * hull.half_length_m / kParts;
      const auto w = [&](int i) {
        return hull.head_m((i + 0.5 - kParts / 2.0) * part_m, 0.0) / (box.density_ratio * box.height_m);
      };
      Complex pairs, spectrum;
      for (int i = 0; i < kParts; ++i) {
        spectrum += w(i) * std::exp(Complex(0.0, k * part_m * i)) * part_m;
        for (int j = 0; j < kParts; ++j)
          pairs += w(i) * w(j) * std::exp(Complex(0.0, -k * part_m * std::abs(i - j))) * part_m * part_m;
      }
      const Complex expected = kDensity_kgpm3 * 9.81 * width_m * Complex(0.0, omega / (2 * c_mps)) * pairs;
      addHeave(
          fmt::format("box of 1.5 m across a channel 0.5 m deep, {} Hz", frequency_hz), *measured, expected, omega,
          fmt::format("waves of half the displaced water to each side, rho g B^2/(2c) = {:.0f} N s/m per metre for k B "
                      "to 0; tolerance: 1 % of the force",
                      kDensity_kgpm3 * 9.81 * kLength_m * kLength_m / (2 * c_mps)),
          rows);
      // The wave that it sends out, 8 m away.
      const sim::StateCopy state = (*made)->copyState();
      const double cells_per_wave = 2 * pi / k / kCell_m;
      double highest = 0.0;
      for (int i = 0; i < static_cast<int>(cells_per_wave); ++i)
        highest = std::max(highest, std::abs(state.elevation_m[static_cast<std::size_t>(256 + 8 / kCell_m + i)]));
      rows.push_back({fmt::format("the same: wave that it sends out, {} Hz", frequency_hz), "of the heave",
                      highest / 0.02, std::abs(spectrum) * omega / (2 * c_mps), Tolerance::kRelative, 0.03,
                      "A = B w/(2c) for k B to 0; tolerance: places of crests"});
    }
  }
  // A boat in open water of finite depth.
  const core::Boat boat{.length_m = 2.4, .beam_m = 1.2, .height_m = 0.8, .density_ratio = 0.25};
  constexpr double kDepth_m = 2.4, kDamping_per_s = 1.0;
  const HullPressure hull = hullPressure(boat, kCell_m);
  const core::Scene scene = hullBasin(boat, kDepth_m, core::Dispersion::kAiry, kDamping_per_s);
  const LinearWater water{scene.gravity_mps2, kDepth_m, true};
  const std::vector<double> frequencies = quick ? std::vector{0.5} : std::vector{0.4, 0.6, 0.75};
  for (const double frequency_hz : frequencies) {
    const double omega = 2 * pi * frequency_hz;
    auto made = sim::WaterSim::create(ctx, scene);
    if (!made) return made.error();
    const int period = static_cast<int>(std::lround(60.0 / frequency_hz));
    const int settling_ticks = period * static_cast<int>(std::ceil(14.0 * frequency_hz));
    auto measured = measureHeave(ctx, **made, boat, omega, settling_ticks, 2 * period);
    if (!measured) return measured.error();
    const Complex expected =
        heaveForce(hull, boat.height_m * boat.density_ratio, water, omega, scene.wave->side_m, kDamping_per_s);
    addHeave(fmt::format("boat 2.4 m x 1.2 m in 2.4 m of water, {} Hz", frequency_hz), *measured, expected, omega,
             fmt::format("linear theory in the same basin, displaced mass {:.0f} kg; tolerance: 1 % of the force",
                         kDensity_kgpm3 * hull.volume_m3),
             rows);
  }
  return CaseResult{std::move(rows), {}};
}

Outcome hullInWaves(gpu::Context& ctx, bool quick) {
  const core::Boat boat{.length_m = 2.4, .beam_m = 0.9, .height_m = 0.8, .density_ratio = 0.25};
  constexpr double kDepth_m = 2.4, kWave_m = 0.02, kDraught_m = 0.2;
  const HullPressure hull = hullPressure(boat, kCell_m);
  const core::Scene scene = hullBasin(boat, kDepth_m, core::Dispersion::kAiry, 0.0);
  const LinearWater water{scene.gravity_mps2, kDepth_m, true};
  std::vector<Row> rows;
  const std::vector<int> modes = quick ? std::vector{4} : std::vector{2, 4, 6};
  for (const int mode : modes) {
    for (const double heading : {0.0, pi / 3}) {
      const double k = 2 * pi * mode / scene.wave->side_m, omega = std::sqrt(water.omega2(k));
      // Standing waves cos(k x); the boat lies where both the wave and its slope are 1/sqrt(2) of their greatest.
      const sim::HullMotion held{.boat_id = 1, .x_m = pi / 4 / k, .y_m = 0.4 - kDraught_m, .heading_rad = heading};
      auto made = sim::WaterSim::create(ctx, scene);
      if (!made) return made.error();
      const auto pose = [&](double) { return held; };
      if (auto done = runMoved(ctx, **made, 61, pose, [](double, const sim::HullForce&) {}); !done) return done.error();
      sim::StateCopy state = (*made)->copyState();
      std::ranges::fill(state.flow_m2ps, 0.0f);
      for (std::size_t i = 0; i < state.elevation_m.size(); ++i) {
        const double x = (static_cast<double>(i % 128) + 0.5) * kCell_m - scene.wave->side_m / 2;
        const double z = (static_cast<double>(i / 128) + 0.5) * kCell_m - scene.wave->side_m / 2;
        const double dx = x - held.x_m;
        state.elevation_m[i] = kWave_m * std::cos(k * x) - hull.head_m(dx * std::cos(heading) + z * std::sin(heading),
                                                                       z * std::cos(heading) - dx * std::sin(heading));
      }
      (*made)->setState(state);
      Oscillation up(omega), along(omega);
      const int tick_count = static_cast<int>(std::lround(3 * 2 * pi / omega * 60));
      if (auto done = runMoved(ctx, **made, tick_count, pose,
                               [&](double t, const sim::HullForce& f) {
                                 up.add(t, f.dynamic.force_n[1]);
                                 along.add(t, f.dynamic.force_n[0]);
                               });
          !done)
        return done.error();
      const double spectrum_m2 = hull.spectrum_m3(k * std::cos(heading), k * std::sin(heading)) / kDraught_m;
      const double expected_n = kDensity_kgpm3 * 9.81 * kWave_m * spectrum_m2 / std::numbers::sqrt2;
      const std::string what =
          fmt::format("held in waves of {:.1f} m, {:.0f} degrees from their way", 2 * pi / k, heading * 180 / pi);
      rows.push_back({what + ": force upward", "N", std::abs(up.amplitude()), expected_n, Tolerance::kRelative, 0.02,
                      "Froude-Krylov, pressure of the wave at the rest level; tolerance: 3 periods in whole ticks"});
      rows.push_back(
          {what + ": force along the waves", "N", std::abs(along.amplitude()), expected_n * k * kDraught_m,
           Tolerance::kRelative, 0.05,
           "the same: its slope times the displaced water; tolerance: drag takes some of the flow across the hull"});
    }
  }
  return CaseResult{std::move(rows), {}};
}

}  // namespace spindrift::study
