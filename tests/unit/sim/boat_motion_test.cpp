// Boats: order of their motion in the tick, and what they exchange with the water.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <shared/boats.h>

#include <spindrift/sim_setup/basin.h>
#include <spindrift/sim_setup/dispersion.h>
#include <spindrift/study/hull_pressure.h>

#include "dispersion_reference.h"
#include "sim_fixture.h"

namespace spindrift::sim {
namespace {

constexpr int kCells = 96;
constexpr double kSide_m = 20.0;
constexpr double kDepth_m = 1.5;
constexpr double kCell_m = kSide_m / kCells;

/// As in shaders/shared/boats.h, of the boat in one slot.
struct BoatState {
  double x_m, y_m, z_m, heading, pitch, roll, forward_mps, sideways_mps, yaw_rate, push_mps2;
};

BoatState boatOf(const StateCopy& state, std::size_t place = 0) {
  const float* b = &state.boats[place * BOAT_TEXELS * 4];
  return {b[0], b[1], b[2], b[3], b[4], b[5], b[8], b[9], b[11], b[27]};
}

class BoatMotion : public OnDevice {
 protected:
  static core::Scene basin(core::Dispersion dispersion, core::WaveBoundary sides) {
    core::Scene scene;
    scene.name = "boat motion";
    scene.wave.emplace();
    scene.wave->resolution_count = kCells;
    scene.wave->side_m = kSide_m;
    scene.wave->depth_m = kDepth_m;
    scene.wave->damping_per_s = 0.0;
    setBoundaries(*scene.wave, sides);
    scene.wave->dispersion = dispersion;
    scene.boats.emplace();
    return scene;
  }

  /// Sets a hump, at rest. The flow belongs half a wave step before the elevation.
  static void raiseHump(WaterSim& sim, const core::Scene& scene) {
    StateCopy state = sim.copyState();
    forCells([&](std::size_t i, double x_m, double z_m) {
      state.elevation_m[i] = 0.15 * std::exp(-(std::pow(x_m - 2.0, 2) + std::pow(z_m + 1.0, 2)) / 4);
    });
    const WaveLayout& layout = *sim.derived().wave;
    const double pull = scene.gravity_mps2 * 0.5 * layout.dt_s / kCell_m;
    std::vector<std::array<double, 2>> drive(state.elevation_m.size());
    if (scene.wave->dispersion == core::Dispersion::kAiry) {
      drive = DispersionReference(layOutDispersion(layout, layOutBasin(scene, layout))).apply(state.elevation_m);
    } else {
      for (std::size_t i = 0; i < drive.size(); ++i) {
        if (i % kCells + 1 < kCells) drive[i][0] = kDepth_m * (state.elevation_m[i + 1] - state.elevation_m[i]);
        if (i / kCells + 1 < kCells) drive[i][1] = kDepth_m * (state.elevation_m[i + kCells] - state.elevation_m[i]);
      }
    }
    for (std::size_t i = 0; i < drive.size(); ++i) {
      for (std::size_t axis = 0; axis < 2; ++axis)
        state.flow_m2ps[2 * i + axis] = static_cast<float>(pull * drive[i][axis]);
    }
    sim.setState(state);
  }

  /// Calls visit(i, x_m, z_m) for each cell and its centre.
  template <typename Visit>
  static void forCells(const Visit& visit) {
    for (std::size_t i = 0; i < std::size_t{kCells} * kCells; ++i) {
      visit(i, (static_cast<double>(i % kCells) + 0.5) * kCell_m - kSide_m / 2,
            (static_cast<double>(i / kCells) + 0.5) * kCell_m - kSide_m / 2);
    }
  }

  /// Pressure of a settled hull at a position, across periodic sides, too. [m]
  static double headAt(const core::Boat& boat, const BoatState& b, double x_m, double z_m) {
    const double dx_m = std::remainder(x_m - b.x_m, kSide_m);
    const double dz_m = std::remainder(z_m - b.z_m, kSide_m);
    return study::hullPressure(boat, kCell_m)
        .head_m(dx_m * std::cos(b.heading) + dz_m * std::sin(b.heading),
                dz_m * std::cos(b.heading) - dx_m * std::sin(b.heading));
  }

  /// x, y, z [m], heading, pitch, roll [rad] after two seconds.
  std::array<double, 6> driveThroughHump(core::Dispersion dispersion, int tick_rate_hz, int wave_rate_hz) {
    core::Scene scene = basin(dispersion, core::WaveBoundary::kReflect);
    scene.tick_rate_hz = tick_rate_hz;
    scene.wave->fixed_substeps_count = static_cast<std::uint32_t>(wave_rate_hz / tick_rate_hz);
    scene.boats->boats = {core::Boat{.x_m = -3.0,
                                     .z_m = 1.0,
                                     .heading_deg = 20.0,
                                     .max_speed_mps = 4.0,
                                     .throttle_ratio = 0.8,
                                     .rudder_ratio = 0.5}};
    WaterSim& sim = make(scene);
    raiseHump(sim, scene);
    for (int i = 0; i < 2 * tick_rate_hz; ++i) sim.step();
    const BoatState b = boatOf(sim.copyState());
    return {b.x_m, b.y_m, b.z_m, b.heading, b.pitch, b.roll};
  }

  /// Root mean square over the positions, and over the angles, of a - b.
  static std::array<double, 2> distance(const std::array<double, 6>& a, const std::array<double, 6>& b) {
    std::array<double, 2> sum{};
    for (std::size_t k = 0; k < 6; ++k) sum[k / 3] += (a[k] - b[k]) * (a[k] - b[k]);
    return {std::sqrt(sum[0] / 3), std::sqrt(sum[1] / 3)};
  }

  void expectSecondOrder(core::Dispersion dispersion, const std::array<int, 4>& tick_rates_hz,
                         const std::array<int, 4>& wave_rates_hz) {
    std::array<std::array<double, 6>, 4> runs{};
    for (std::size_t k = 0; k < 4; ++k) runs[k] = driveThroughHump(dispersion, tick_rates_hz[k], wave_rates_hz[k]);
    for (std::size_t k = 0; k + 2 < 4; ++k) {
      const auto coarse = distance(runs[k], runs[k + 1]);
      const auto fine = distance(runs[k + 1], runs[k + 2]);
      // A GPU's sin, cos and atan are good to about 2^-21, which a boat at 4 m/s turns into some 1e-5 m in two seconds.
      const double floor = ctx_->device().is_software ? 0.0 : 5e-5;
      EXPECT_TRUE(fine[0] <= floor || std::log2(coarse[0] / fine[0]) >= 1.9)
          << "places, from " << tick_rates_hz[k] << " Hz: " << coarse[0] << ", " << fine[0];
      EXPECT_TRUE(fine[1] <= floor || std::log2(coarse[1] / fine[1]) >= 1.9)
          << "angles, from " << tick_rates_hz[k] << " Hz: " << coarse[1] << ", " << fine[1];
    }
  }
};

TEST_F(BoatMotion, IsOfSecondOrderInTheTick) {
  expectSecondOrder(core::Dispersion::kNone, {15, 30, 60, 120}, {120, 120, 120, 120});
}

TEST_F(BoatMotion, IsOfSecondOrderInTheTickOnWavesThatDisperse) {
  expectSecondOrder(core::Dispersion::kAiry, {15, 30, 60, 120}, {120, 120, 120, 120});
}

TEST_F(BoatMotion, IsOfSecondOrderTogetherWithTheWave) {
  expectSecondOrder(core::Dispersion::kNone, {30, 60, 120, 240}, {30, 60, 120, 240});
}

TEST_F(BoatMotion, AHullAtRestIsNotPushedByItsOwnDent) {
  core::Scene scene = basin(core::Dispersion::kNone, core::WaveBoundary::kReflect);
  scene.obstacles = {core::Rock{4.0, 1.0, 1.5, 0.8}};
  scene.boats->boats = {core::Boat{.x_m = 0.037, .z_m = -0.081, .heading_deg = 33.0},
                        core::Boat{.x_m = 8.1, .z_m = 8.9, .heading_deg = 2.0},                      // along a side
                        core::Boat{.x_m = 4.0, .z_m = 3.2},                                          // beside the rock
                        core::Boat{.x_m = -6.0, .z_m = -5.0, .heading_deg = -70.0, .beam_m = 0.2}};  // spread
  WaterSim& sim = make(scene);
  for (int i = 0; i < 70; ++i) sim.step();  // the hulls press with their full weight
  StateCopy state = sim.copyState();
  std::ranges::fill(state.elevation_m, 0.0);
  std::ranges::fill(state.flow_m2ps, 0.0f);
  const Basin ground = layOutBasin(scene, *sim.derived().wave);
  for (std::size_t place = 0; place < 4; ++place) {
    const core::Boat& boat = scene.boats->boats[place];
    float* b = &state.boats[place * BOAT_TEXELS * 4];
    b[1] = static_cast<float>(boat.height_m * (0.5 - boat.density_ratio));
    for (const int at : {4, 5, 8, 9, 10, 11, 12, 13, 24, 25, 26}) b[at] = 0.0f;  // level and at rest, like the water
    forCells([&](std::size_t i, double x_m, double z_m) {
      if (ground.depth_m[i] > 0) state.elevation_m[i] -= headAt(boat, boatOf(state, place), x_m, z_m);
    });
  }
  sim.setState(state);
  for (int i = 0; i < 60; ++i) sim.step();
  const StateCopy after = sim.copyState();
  for (std::size_t place = 0; place < 4; ++place) {
    const BoatState start = boatOf(state, place);
    const BoatState end = boatOf(after, place);
    EXPECT_NEAR(end.push_mps2, 0.0, 1e-5) << place;
    EXPECT_NEAR(end.forward_mps, 0.0, 1e-5) << place;
    EXPECT_NEAR(end.sideways_mps, 0.0, 1e-5) << place;
    EXPECT_NEAR(end.yaw_rate, 0.0, 1e-5) << place;
    EXPECT_NEAR(end.y_m, start.y_m, 1e-5) << place;
    EXPECT_NEAR(end.pitch, 0.0, 1e-5) << place;
    EXPECT_NEAR(end.roll, 0.0, 1e-5) << place;
  }
}

TEST_F(BoatMotion, TheDentOfAHullAtRestIsItsPressure) {
  core::Scene scene = basin(core::Dispersion::kNone, core::WaveBoundary::kReflect);
  scene.wave->damping_per_s = 2.0;
  const core::Boat wide{.x_m = -3.03, .z_m = 1.17, .heading_deg = 30.0};
  const core::Boat narrow{.x_m = 4.0, .z_m = -3.0, .heading_deg = -20.0, .beam_m = 0.3};
  scene.boats->boats = {wide, narrow};
  WaterSim& sim = make(scene);
  for (int i = 0; i < 1500; ++i) sim.step();
  const StateCopy state = sim.copyState();
  const double level_m = state.elevation_m[5 + kCells * 5];
  for (std::size_t place = 0; place < 2; ++place) {
    const core::Boat& boat = scene.boats->boats[place];
    const study::HullPressure hull = study::hullPressure(boat, kCell_m);
    const BoatState b = boatOf(state, place);
    double worst_m = 0.0;
    double volume_m3 = 0.0;
    forCells([&](std::size_t i, double x_m, double z_m) {
      if (std::hypot(x_m - b.x_m, z_m - b.z_m) > 2.5) return;
      const double dent_m = level_m - state.elevation_m[i];
      worst_m = std::max(worst_m, std::abs(dent_m - headAt(boat, b, x_m, z_m)));
      volume_m3 += dent_m * kCell_m * kCell_m;
    });
    EXPECT_LT(worst_m, 0.01 * hull.peak_m) << place;
    EXPECT_NEAR(volume_m3, hull.volume_m3, 0.01 * hull.volume_m3) << place;
  }
}

TEST_F(BoatMotion, WavesGainTheEnergyThatTheirResistanceTakesFromTheBoat) {
  for (const auto dispersion : {core::Dispersion::kNone, core::Dispersion::kAiry}) {
    const bool disperses = dispersion == core::Dispersion::kAiry;
    core::Scene scene = basin(dispersion, core::WaveBoundary::kPeriodic);
    const core::Boat boat{
        .x_m = -8.0, .z_m = 0.3, .heading_deg = 10.0, .max_speed_mps = disperses ? 4.5 : 6.0, .throttle_ratio = 1.0};
    scene.boats->boats = {boat};
    WaterSim& sim = make(scene);
    const double dt_s = sim.derived().tick_s;
    ASSERT_EQ(sim.derived().wave->substeps_count, 1u);
    const double volume_m3 = study::hullPressure(boat, kCell_m).volume_m3;
    // The flow is q = -F grad(impulse), impulse = g dt sum (eta + head). So its energy, q F^-1 q / 2, is -q
    // grad(impulse) / 2 whatever the dispersion F is, with the flows half a step before and after, whose product the
    // leapfrog conserves.
    std::vector<double> impulse_m2ps(std::size_t{kCells} * kCells, 0.0);
    std::vector<double> energy,
        work;  // over the water's density [m^5/s^2]: of the waves and of the hull's position in them
    StateCopy state = sim.copyState();
    for (int tick = 0; tick < 270; ++tick) {
      const BoatState b = boatOf(state);
      const double settled = std::min(1.0, state.boats[6] / double{BOAT_SETTLING_S}) * (1.0 - state.boats[21]);
      double sum = 0.0;
      forCells([&](std::size_t i, double x_m, double z_m) {
        const double head_m = settled * headAt(boat, b, x_m, z_m);
        const double eta_m = state.elevation_m[i];
        impulse_m2ps[i] += scene.gravity_mps2 * dt_s * (eta_m + head_m);
        sum += scene.gravity_mps2 * (0.5 * eta_m + head_m) * eta_m;
      });
      forCells([&](std::size_t i, double, double) {
        const std::size_t right = i % kCells + 1 < kCells ? i + 1 : i + 1 - kCells;
        const std::size_t after = (i + kCells) % impulse_m2ps.size();
        sum -= 0.5 / kCell_m * state.flow_m2ps[2 * i] * (impulse_m2ps[right] - impulse_m2ps[i]);
        sum -= 0.5 / kCell_m * state.flow_m2ps[2 * i + 1] * (impulse_m2ps[after] - impulse_m2ps[i]);
      });
      energy.push_back(sum * kCell_m * kCell_m);
      const double before_mps2 = b.push_mps2;
      sim.step();
      state = sim.copyState();
      // The push belongs to the time of the position, the speed to half a tick later.
      work.push_back(-volume_m3 * 0.5 * (before_mps2 + boatOf(state).push_mps2) * b.forward_mps * dt_s);
    }
    double done = 0.0;
    for (std::size_t tick = 90; tick < 269; ++tick) done += work[tick];
    EXPECT_GT(done, 0.5);
    EXPECT_NEAR(energy[269] - energy[90], done, 0.01 * done) << (disperses ? "with" : "without") << " dispersion";
  }
}

TEST_F(BoatMotion, TwiceTheDisplacementMakesTwiceTheWaves) {
  for (const double beam_m : {0.9, 0.25}) {  // also narrower than three cells
    std::array<double, 2> height_m{};
    for (const std::size_t heavy : {0u, 1u}) {
      core::Scene scene = basin(core::Dispersion::kAiry, core::WaveBoundary::kReflect);
      scene.boats->boats = {core::Boat{.x_m = -8.0,
                                       .beam_m = beam_m,
                                       .height_m = 0.2,
                                       .density_ratio = heavy == 1 ? 0.2 : 0.1,
                                       .max_speed_mps = 4.0,
                                       .throttle_ratio = 1.0}};
      WaterSim& sim = make(scene);
      for (int i = 0; i < 300; ++i) sim.step();
      const auto [low, high] = std::ranges::minmax(sim.copyState().elevation_m);
      height_m[heavy] = high - low;
    }
    EXPECT_NEAR(height_m[1] / height_m[0], 2.0, 0.1) << beam_m;
  }
}

TEST_F(BoatMotion, ABoatWithThrustEnoughPassesTheSpeedOfShallowWaves) {
  for (const auto dispersion : {core::Dispersion::kNone, core::Dispersion::kAiry}) {
    core::Scene scene = basin(dispersion, core::WaveBoundary::kPeriodic);
    scene.wave->depth_m = 0.4;
    scene.wave->damping_per_s = 0.3;
    const double c_mps = std::sqrt(scene.gravity_mps2 * scene.wave->depth_m);
    double hindered_mps = 0.0;
    for (const double full_speed : {1.1, 2.0}) {
      scene.boats->boats = {core::Boat{
          .height_m = 0.4, .density_ratio = 0.25, .max_speed_mps = full_speed * c_mps, .throttle_ratio = 1.0}};
      WaterSim& sim = make(scene);
      double fastest_mps = 0.0;
      for (int i = 0; i < 900; ++i) {
        sim.step();
        if (i % 30 == 0) fastest_mps = std::max(fastest_mps, boatOf(sim.copyState()).forward_mps);
      }
      if (full_speed > 1.5)
        EXPECT_GT(fastest_mps, 1.1 * c_mps);
      else
        hindered_mps = fastest_mps;
    }
    EXPECT_LT(hindered_mps, c_mps) << "its waves keep a weaker boat below their speed";
  }
}

}  // namespace
}  // namespace spindrift::sim
