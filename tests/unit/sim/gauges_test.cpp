// Gauges: what they read of known water, and how long they remember it.
#include <algorithm>
#include <cmath>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <spindrift/sim/gauge_history.h>
#include <spindrift/sim_setup/basin.h>

#include "seiche.h"

namespace spindrift::sim {
namespace {

class GaugesOnDevice : public SeicheOnDevice {
 protected:
  /// Runs until the gauges have so many ticks: they are some ticks behind.
  static void run(WaterSim& sim, std::size_t tick_count) {
    for (std::size_t k = 0; k < 2 * tick_count + 8 && sim.gauges()->series(0).time_s.size() < tick_count; ++k)
      sim.step();
    ASSERT_GE(sim.gauges()->series(0).time_s.size(), tick_count);
  }
};

TEST_F(GaugesOnDevice, ReadTheElevationAndVelocityOfAStandingWave) {
  core::Scene scene = seicheScene();
  for (const double x_m : {-5.9, -3.3, 0.17, 2.0, 5.99}) scene.gauges.push_back({.name = "g", .x_m = x_m, .z_m = 1.3});
  WaterSim& sim = make(scene);
  startSeiche(sim);
  constexpr std::size_t kTicks = 240;
  run(sim, kTicks);
  const double k_radpm = wavenumber_radpm();
  const double omega_radps = k_radpm * std::sqrt(scene.gravity_mps2 * scene.wave->depth_m);
  const double speed_mps = kAmplitude_m * scene.gravity_mps2 * k_radpm / omega_radps;
  for (std::size_t g = 0; g < scene.gauges.size(); ++g) {
    const double from_wall_m = scene.gauges[g].x_m + kPoolSide_m / 2;
    const GaugeHistory::Series series = sim.gauges()->series(g);
    double worst_eta_m = 0.0, worst_u_mps = 0.0, worst_w_mps = 0.0;
    for (std::size_t k = 0; k < series.time_s.size(); ++k) {
      const double t_s = series.time_s[k];
      const double eta_m = kAmplitude_m * std::cos(k_radpm * from_wall_m) * std::cos(omega_radps * t_s);
      const double u_mps =
          speed_mps * std::sin(k_radpm * from_wall_m) * std::sin(omega_radps * (t_s - sim.derived().wave->dt_s / 2));
      worst_eta_m = std::max(worst_eta_m, std::abs(series.readings[k].elevation_m - eta_m));
      worst_u_mps = std::max(worst_u_mps, std::abs(series.readings[k].velocity_x_mps - u_mps));
      worst_w_mps = std::max(worst_w_mps, std::abs(double{series.readings[k].velocity_z_mps}));
    }
    EXPECT_LE(worst_eta_m, 0.002 * kAmplitude_m) << scene.gauges[g].x_m;
    // Beyond the centre of the last cell a gauge reads that cell.
    EXPECT_LE(worst_u_mps, (std::abs(scene.gauges[g].x_m) > 5.8 ? 0.03 : 0.002) * speed_mps) << scene.gauges[g].x_m;
    EXPECT_EQ(worst_w_mps, 0.0);
  }
}

TEST_F(GaugesOnDevice, HaveOneReadingPerTickAndForgetItAtAReset) {
  core::Scene scene = seicheScene();
  scene.gauges = {{.name = "g", .x_m = -5, .z_m = 0}};
  WaterSim& sim = make(scene);
  startSeiche(sim);
  run(sim, 50);
  const GaugeHistory::Series series = sim.gauges()->series(0);
  for (std::size_t k = 0; k < series.time_s.size(); ++k)
    EXPECT_NEAR(series.time_s[k], static_cast<double>(k + 1) * sim.derived().tick_s, 1e-9);
  EXPECT_GT(sim.gauges()->now()[0].highest_m, 0.9 * kAmplitude_m * std::cos(wavenumber_radpm()));
  sim.reset();
  EXPECT_TRUE(sim.gauges()->series(0).time_s.empty());
  EXPECT_EQ(sim.gauges()->newestTime_s(), 0.0);
  run(sim, 3);
  EXPECT_NEAR(sim.gauges()->series(0).time_s[0], sim.derived().tick_s, 1e-9) << "no reading of the time before";
  EXPECT_EQ(sim.gauges()->now()[0].highest_m, 0.0F);
}

/// On land that the water can reach, the water of a gauge lies on the ground.
TEST_F(GaugesOnDevice, ReadTheGroundUntilWaterComes) {
  core::Scene scene = seicheScene();
  scene.wave->bulk = core::Bulk::kNonlinear;
  scene.beaches = {core::Beach{core::Side::kPlusX, 6.0, -0.5}};
  // Ground rises from -1.5 m at x = 0 by a third of x.
  scene.gauges = {{.name = "land", .x_m = 5.4, .z_m = 0}};
  WaterSim& sim = make(scene);
  run(sim, 3);
  const GaugeReading dry = sim.gauges()->series(0).readings.back();
  EXPECT_NEAR(dry.elevation_m, 0.3, 0.02);
  EXPECT_EQ(dry.velocity_x_mps, 0.0F);
  StateCopy state = sim.copyState();
  for (double& elevation_m : state.elevation_m) elevation_m = std::max(elevation_m, 0.4);
  sim.setState(state);
  run(sim, 12);
  EXPECT_NEAR(sim.gauges()->series(0).readings.back().elevation_m, 0.4, 0.02);
}

/// Beside dry ground the wet cells alone count; on it everything is 0.
TEST_F(GaugesOnDevice, DoNotMixDryGroundIntoTheirReadings) {
  core::Scene scene = seicheScene();
  scene.bed.emplace();
  // A vertical step in the middle: water 1.5 m deep on the left of x = 0, land on the right.
  scene.bed->shapes = {core::BedSill{
      .x_m = 3, .z_m = 0, .heading_deg = 90, .length_m = 20, .crest_width_m = 6, .flank_width_m = 0, .height_m = 2}};
  scene.gauges = {{.name = "edge", .x_m = -0.01, .z_m = 0}, {.name = "land", .x_m = 3, .z_m = 0}};
  WaterSim& sim = make(scene);
  StateCopy state = sim.copyState();
  const Basin basin = layOutBasin(scene, *sim.derived().wave);
  for (std::size_t i = 0; i < state.elevation_m.size(); ++i) state.elevation_m[i] = basin.depth_m[i] > 0 ? 0.2 : 0.0;
  sim.setState(state);
  run(sim, 10);
  for (const GaugeReading& reading : sim.gauges()->series(0).readings) EXPECT_NEAR(reading.elevation_m, 0.2, 1e-6);
  for (const GaugeReading& reading : sim.gauges()->series(1).readings) EXPECT_EQ(reading.elevation_m, 0.0F);
}

TEST_F(GaugesOnDevice, ChangeNothingInTheWaterAndCostOneDispatch) {
  const auto hashAndDispatches = [&](const core::Scene& scene) {
    WaterSim& sim = make(scene);
    startSeiche(sim);
    for (int k = 0; k < 5; ++k) sim.step();
    const std::uint64_t before = ctx_->ledger().dispatch_count;
    for (int k = 0; k < 40; ++k) sim.step();
    return std::pair(sim.stateHash(), (ctx_->ledger().dispatch_count - before) / 40);
  };
  core::Scene scene = seicheScene();
  const auto without = hashAndDispatches(scene);
  for (int k = 0; k < 64; ++k) scene.gauges.push_back({.name = "g", .x_m = -5.9 + 0.18 * k, .z_m = 0.05 * k});
  const auto with = hashAndDispatches(scene);
  EXPECT_EQ(with.first, without.first);
  EXPECT_EQ(with.second, without.second + 1);
}

/// Whatever the scene has, at most 64 are one group of the same dispatch.
TEST_F(GaugesOnDevice, ThatArePlacedLaterReadAsThoseOfTheSceneFromThatTickOn) {
  core::Scene scene = seicheScene();
  scene.gauges = {{.name = "a", .x_m = -3.3, .z_m = 1.3}, {.name = "b", .x_m = 5.1, .z_m = -2}};
  WaterSim& sim = make(scene);
  startSeiche(sim);
  run(sim, 20);
  const double placed_s = sim.time_s();
  ASSERT_TRUE(sim.placeGauges(std::vector<GaugePlace>{{7, 5.1, -2}, {9, -3.3, 1.3}}));
  run(sim, 60);
  ASSERT_TRUE(sim.placeGauges(std::vector<GaugePlace>{{9, -3.3, 1.3}}));
  EXPECT_EQ(sim.placedGauge(7), nullptr);
  run(sim, 100);
  const GaugeHistory::Series of_scene = sim.gauges()->series(0);
  const GaugeHistory::Series placed = sim.placedGauge(9)->series(0);
  ASSERT_GT(placed.time_s.size(), 70u);
  EXPECT_NEAR(placed.time_s.front(), placed_s + sim.derived().tick_s, 1e-9);
  EXPECT_EQ(placed.time_s.back(), of_scene.time_s.back());
  const std::size_t before = of_scene.time_s.size() - placed.time_s.size();
  for (std::size_t k = 0; k < placed.time_s.size(); ++k) {
    ASSERT_EQ(placed.time_s[k], of_scene.time_s[before + k]);
    ASSERT_EQ(placed.readings[k].elevation_m, of_scene.readings[before + k].elevation_m) << k;
    ASSERT_EQ(placed.readings[k].velocity_x_mps, of_scene.readings[before + k].velocity_x_mps) << k;
  }
  EXPECT_GT(sim.placedGauge(9)->now()[0].highest_m, sim.placedGauge(9)->now()[0].lowest_m);
  sim.reset();
  EXPECT_TRUE(sim.placedGauge(9)->series(0).time_s.empty()) << "it stays, and begins anew";
  run(sim, 3);
  EXPECT_NEAR(sim.placedGauge(9)->series(0).time_s.front(), sim.derived().tick_s, 1e-9);
}

TEST_F(GaugesOnDevice, ThatArePlacedChangeNothingInTheWaterAndCostNothingBeforeAndAfter) {
  const auto run40 = [&](WaterSim& sim) {
    const std::uint64_t before = ctx_->ledger().dispatch_count;
    for (int k = 0; k < 40; ++k) sim.step();
    return (ctx_->ledger().dispatch_count - before) / 40;
  };
  WaterSim& plain = make(seicheScene());
  startSeiche(plain);
  const std::uint64_t plain_count = run40(plain);
  run40(plain);
  run40(plain);
  const std::uint64_t plain_hash = plain.stateHash();
  WaterSim& sim = make(seicheScene());  // in place of the one before
  startSeiche(sim);
  EXPECT_EQ(run40(sim), plain_count);
  std::vector<GaugePlace> places;
  for (std::uint32_t k = 1; k <= core::kMaxGauges; ++k) places.push_back({k, -5.9 + 0.18 * k, -0.05 * k});
  ASSERT_TRUE(sim.placeGauges(places));
  EXPECT_EQ(run40(sim), plain_count + 1);
  ASSERT_TRUE(sim.placeGauges({}));
  EXPECT_EQ(run40(sim), plain_count);
  EXPECT_EQ(sim.stateHash(), plain_hash);
}

TEST_F(GaugesOnDevice, ThatArePlacedAreBoundedAndNeedAWave) {
  core::Scene scene = seicheScene();
  scene.gauges = {{.name = "a", .x_m = -3.3, .z_m = 1.3}};
  WaterSim& sim = make(scene);
  const std::vector<GaugePlace> places(core::kMaxGauges);
  const auto refused = sim.placeGauges(places);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, testing::HasSubstr("64 gauges and 1 of the scene are more than 64"));
  core::Scene box;
  box.particles.emplace();
  const auto none = make(box).placeGauges(std::vector<GaugePlace>{{1, 0, 0}});
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message, testing::HasSubstr("no wave"));
}

TEST(GaugeHistory, KeepsTheNewestTicksInOrderAndTheExtremesOfAll) {
  GaugeHistory history(2);
  constexpr std::size_t kCount = GaugeHistory::kTickMaxCount + 100;
  for (std::size_t k = 0; k < kCount; ++k) {
    const auto height_m = static_cast<float>(k);
    history.add(static_cast<double>(k),
                std::vector<GaugeReading>{{.elevation_m = height_m}, {.elevation_m = -height_m}});
  }
  EXPECT_EQ(history.newestTime_s(), history.series(0).time_s.back());
  const GaugeHistory::Series series = history.series(1);
  ASSERT_EQ(series.time_s.size(), GaugeHistory::kTickMaxCount);
  for (std::size_t k = 0; k < series.time_s.size(); ++k) {
    ASSERT_EQ(series.time_s[k], static_cast<double>(100 + k));
    ASSERT_EQ(series.readings[k].elevation_m, -static_cast<float>(100 + k));
  }
  EXPECT_EQ(history.now()[0].highest_m, static_cast<float>(kCount - 1));
  EXPECT_EQ(history.now()[0].lowest_m, 0.0F) << "of ticks that are no longer kept, too";
  EXPECT_EQ(history.now()[1].lowest_m, -static_cast<float>(kCount - 1));
}

}  // namespace
}  // namespace spindrift::sim
