// Fingers in the water on the device: exact volume, a wake, bounds, and the same again from a saved state.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <tuple>
#include <vector>

#include "sim_fixture.h"

namespace spindrift::sim {
namespace {

using core::Bulk;
using core::Dispersion;

/// 64 x 64 cells of an eighth of a metre, walls all round.
core::Scene basinOf(Bulk bulk, Dispersion dispersion) {
  core::Scene scene;
  scene.name = "basin";
  scene.wave.emplace();
  scene.wave->resolution_count = 64;
  scene.wave->side_m = 8.0;
  scene.wave->depth_m = 1.0;
  scene.wave->damping_per_s = 0.0;
  scene.wave->bulk = bulk;
  scene.wave->dispersion = dispersion;
  setBoundaries(*scene.wave, core::WaveBoundary::kReflect);
  return scene;
}

constexpr double kRadius_m = 0.5, kDepth_m = 0.15;

/// Points of a finger that goes round a circle, from time to time.
std::vector<StrokePoint> circle(double radius_m, double speed_mps, double from_s, double to_s) {
  std::vector<StrokePoint> out;
  for (double t = from_s; t < to_s - 1e-9; t += 1.0 / 120.0) {
    const double angle = speed_mps * t / radius_m;
    out.push_back({t, radius_m * std::cos(angle), radius_m * std::sin(angle), 1.0});
  }
  return out;
}

double sum(const StateCopy& state) {
  return std::accumulate(state.elevation_m.begin(), state.elevation_m.end(), 0.0);
}

double highest(const StateCopy& state) {
  double out = 0.0;
  for (const double v : state.elevation_m) out = std::max(out, std::abs(v));
  return out;
}

class StrokesOnDevice : public OnDevice, public ::testing::WithParamInterface<std::tuple<Bulk, Dispersion>> {
 protected:
  [[nodiscard]] static core::Scene basin() { return basinOf(std::get<0>(GetParam()), std::get<1>(GetParam())); }
};

TEST_P(StrokesOnDevice, MoveWaterAndKeepItsVolumeToTheUnit) {
  WaterSim& water = make(basin());
  const double before_m = sum(water.copyState());
  // Along a wall into a corner, where a part of the dent has no water to take.
  ASSERT_TRUE(
      water.draw({1, 1, kRadius_m, kDepth_m, {{0, -3.9, -3.9, 1}, {0.5, 0.0, -3.9, 1}, {1.0, 3.9, -3.9, 0.5}}, true}));
  double most_m = 0.0;
  for (int k = 0; k < 120; ++k) {
    water.step();
    const StateCopy state = water.copyState();
    most_m = std::max(most_m, highest(state));
    ASSERT_EQ(sum(state), before_m) << "tick " << k;
  }
  EXPECT_GT(most_m, 0.3 * kDepth_m);
  EXPECT_TRUE(water.strokes().empty());
  EXPECT_EQ(water.health().surface_units, 0);
}

TEST_P(StrokesOnDevice, WakeOfOneMirrorsThatOfItsMirror) {
  std::vector<double> crossed[2];
  for (const int side : {0, 1}) {
    WaterSim& water = make(basin());
    const double s = side == 0 ? 1.0 : -1.0;
    ASSERT_TRUE(water.draw({1, 1, kRadius_m, kDepth_m, {{0, s * -2.0, 0.5, 1}, {1.0, s * 2.0, 0.5, 1}}, true}));
    for (int k = 0; k < 75; ++k) water.step();
    crossed[side] = water.copyState().elevation_m;
  }
  double difference_m = 0.0, most_m = 0.0;
  for (std::size_t z = 0; z < 64; ++z) {
    for (std::size_t x = 0; x < 64; ++x) {
      difference_m = std::max(difference_m, std::abs(crossed[0][x + 64 * z] - crossed[1][63 - x + 64 * z]));
      most_m = std::max(most_m, std::abs(crossed[0][x + 64 * z]));
    }
  }
  EXPECT_GT(most_m, 0.02);
  EXPECT_LE(difference_m, 0.01 * most_m);
}

TEST_P(StrokesOnDevice, StirredAtTheSpeedOfItsWavesTheBasinStaysBounded) {
  core::Scene scene = basin();
  scene.wave->damping_per_s = 0.05;
  WaterSim& water = make(scene);
  const double speed_mps = std::sqrt(scene.gravity_mps2 * scene.wave->depth_m);
  double most_m = 0.0, sent_s = 0.0;
  for (int k = 0; k < 900; ++k) {
    if (water.time_s() + 0.1 > sent_s) {
      for (std::uint32_t finger = 0; finger < 10; ++finger)
        ASSERT_TRUE(water.draw({1, finger, kRadius_m, kDepth_m, circle(2.5, speed_mps, sent_s, sent_s + 0.1)}));
      sent_s += 0.1;
    }
    water.step();
    if (k % 10 == 0) most_m = std::max(most_m, highest(water.copyState()));
  }
  RecordProperty("highest_over_depth", std::to_string(most_m / kDepth_m));
  // Open water: 4 depths at most, from which on strokes press no more. A wall doubles what comes back from it.
  EXPECT_LE(most_m, 8 * kDepth_m) << "ten fingers at one place";
  EXPECT_GE(most_m, kDepth_m);
  EXPECT_EQ(water.recoveredCount(), 0u);
  EXPECT_EQ(water.health().surface_units, 0);
}

TEST_P(StrokesOnDevice, GoOnFromASavedStateAsTheyWouldHave) {
  WaterSim& water = make(basin());
  ASSERT_TRUE(water.draw({1, 1, kRadius_m, kDepth_m, circle(2.0, 1.5, 0.0, 1.0), true}));
  for (int k = 0; k < 20; ++k) water.step();
  const SavedState saved = water.savedState();
  SavedState lifted = saved;
  lifted.host.effects.strokes().clear();
  EXPECT_NE(hashOf(saved), hashOf(lifted)) << "a stroke is a part of the state";
  for (int k = 0; k < 60; ++k) water.step();
  const StateCopy straight = water.copyState();
  ASSERT_TRUE(water.restore(saved));
  ASSERT_EQ(water.strokes().size(), 1u);
  for (int k = 0; k < 60; ++k) water.step();
  EXPECT_TRUE(water.copyState() == straight);
}

TEST_P(StrokesOnDevice, RainRipplesItsDiscAndKeepsTheVolumeToTheUnit) {
  WaterSim& water = make(basin());
  const double before_m = sum(water.copyState());
  // A part of the disc lies outside of the water.
  ASSERT_TRUE(water.draw({1, 1, 1.0, 0.05, {{0, -3.5, 0, 1}, {1.0, -3.5, 0, 1}}, true, StrokeTool::kRain}));
  double near_m = 0.0, far_m = 0.0;
  for (int k = 0; k < 40; ++k) {
    water.step();
    const StateCopy state = water.copyState();
    ASSERT_EQ(sum(state), before_m) << "tick " << k;
    for (std::size_t z = 24; z < 40; ++z) {
      near_m = std::max(near_m, std::abs(state.elevation_m[2 + 64 * z]));
      far_m = std::max(far_m, std::abs(state.elevation_m[60 + 64 * z]));
    }
  }
  EXPECT_GT(near_m, 0.01);
  EXPECT_LT(far_m, 0.2 * near_m);
}

TEST_P(StrokesOnDevice, CalmTakesTheWavesFromItsDiscAndNoWater) {
  const auto move = [](WaterSim& water, bool calmed) {
    const double before_m = sum(water.copyState());
    EXPECT_TRUE(water.draw({1, 1, 0.7, 0.15, circle(2.0, 3.0, 0.0, 2.0), true}));
    for (std::uint32_t k = 0; calmed && k < 9; ++k) {
      const double x_m = 2.6 * (k % 3) - 2.6, z_m = 2.6 * static_cast<double>(k / 3) - 2.6;
      EXPECT_TRUE(water.draw({2, k, 2.0, 0.1, {{0, x_m, z_m, 1}, {5.0, x_m, z_m, 1}}, true, StrokeTool::kCalm}));
    }
    for (int k = 0; k < 240; ++k) water.step();
    const StateCopy state = water.copyState();
    EXPECT_EQ(sum(state), before_m);
    return highest(state);
  };
  const double free_m = move(make(basin()), false);
  EXPECT_GT(free_m, 0.01);
  EXPECT_LT(move(make(basin()), true), 0.25 * free_m);
}

TEST_P(StrokesOnDevice, PaddleSendsItsWaveInItsDirection) {
  WaterSim& water = make(basin());
  const double before_m = sum(water.copyState());
  core::BreakingWave wave{.side = core::Side::kDirection, .amplitude_m = 0.1, .length_m = 1.0, .duration_s = 0.3};
  wave.shape = core::WaveShape::kSwell;
  wave.width_m = 3.0;
  wave.x_m = -1.0;
  wave.z_m = 0.5;
  ASSERT_TRUE(water.start(wave));
  double ahead_m = 0.0, behind_m = 0.0, beside_m = 0.0;
  const auto at = [](const StateCopy& state, double x_m, double z_m) {
    return state.elevation_m[static_cast<std::size_t>((x_m + 4) * 8) + 64 * static_cast<std::size_t>((z_m + 4) * 8)];
  };
  for (int k = 0; k < 60; ++k) {
    water.step();
    const StateCopy state = water.copyState();
    ASSERT_EQ(sum(state), before_m) << "tick " << k;
    ahead_m = std::max(ahead_m, at(state, 0.8, 0.5));
    behind_m = std::max(behind_m, at(state, -3.2, 0.5));
    beside_m = std::max(beside_m, at(state, -1.0, -3.0));
  }
  EXPECT_GT(ahead_m, 0.03) << "of 0.1 m; dispersion spreads it";
  EXPECT_LT(behind_m, 0.5 * ahead_m);
  EXPECT_LT(beside_m, 0.5 * ahead_m);
}

INSTANTIATE_TEST_SUITE_P(Waters, StrokesOnDevice,
                         testing::Values(std::tuple(Bulk::kLinear, Dispersion::kNone),
                                         std::tuple(Bulk::kLinear, Dispersion::kAiry),
                                         std::tuple(Bulk::kNonlinear, Dispersion::kNone)));

TEST_F(OnDevice, StrokeThroughParticlesStirsThemAndEjectsNone) {
  core::Scene scene = smallScene();
  scene.wave.reset();
  scene.coupling.reset();
  scene.particles->solver = core::PressureSolver::kPositionBased;
  WaterSim& water = make(scene);
  for (int k = 0; k < 60; ++k) water.step();
  const double before_mps = water.health().max_speed_mps;
  ASSERT_TRUE(water.draw({1, 1, 0.3, 0.1, circle(0.5, 1.0, 0.0, 1.0), true}));
  double fastest_mps = 0.0;
  for (int k = 0; k < 90; ++k) {
    water.step();
    fastest_mps = std::max(fastest_mps, water.health().max_speed_mps);
  }
  EXPECT_GT(fastest_mps, before_mps);
  EXPECT_LT(fastest_mps, 10.0);
  EXPECT_EQ(water.health().nonfinite_count, 0u);
  EXPECT_EQ(water.health().escaped_count, 0u);
  EXPECT_TRUE(water.strokes().empty());
}

}  // namespace
}  // namespace spindrift::sim
