// Wave-makers on the device: exact volume, no less than nothing, the same waves twice, and after a reset.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <vector>

#include <shared/fixed_point.h>

#include <spindrift/sim_setup/basin.h>
#include <spindrift/sim_setup/fill_up.h>

#include "sim_fixture.h"

namespace spindrift::sim {
namespace {

using core::Bulk;
using core::Dispersion;
using core::Side;
using core::WaveBoundary;

/// 48 x 40 cells of a quarter of a metre, 1 m deep, walls all round.
core::Scene basinOf(Bulk bulk, Dispersion dispersion) {
  core::Scene scene;
  scene.name = "basin";
  scene.wave.emplace();
  core::WaveScene& wave = *scene.wave;
  wave.resolution_count = 48;
  wave.side_m = 12.0;
  wave.width_m = 10.0;
  wave.depth_m = 1.0;
  wave.damping_per_s = 0.0;
  wave.bulk = bulk;
  wave.dispersion = dispersion;
  setBoundaries(wave, WaveBoundary::kReflect);
  return scene;
}

core::WaveMaker makerOf(Side side, double height_m, double period_s = 3.0) {
  return {.side = side, .waves = core::RegularWaves{.height_m = height_m, .period_s = period_s}};
}

std::int64_t leastHeldUnits(WaterSim& water) {
  const Basin basin = layOutBasin(water.scene(), *water.derived().wave);
  const StateCopy state = water.copyState();
  std::int64_t least = 1'000'000'000;
  for (std::size_t i = 0; i < state.elevation_m.size(); ++i) {
    const std::int64_t units = std::llround(state.elevation_m[i] * double{ELEVATION_UNITS_PER_M});
    least = std::min(least, units + bedUnits(basin.bed[i][2]));
  }
  return least;
}

double highest(const StateCopy& state) {
  return *std::ranges::max_element(state.elevation_m);
}

class WaveMakersOnDevice : public OnDevice, public ::testing::WithParamInterface<std::tuple<Bulk, Dispersion>> {
 protected:
  [[nodiscard]] static core::Scene basin() { return basinOf(std::get<0>(GetParam()), std::get<1>(GetParam())); }
};

TEST_P(WaveMakersOnDevice, OfNoHeightDoNotMoveLevelWaterByOneUnit) {
  core::Scene scene = basin();
  scene.wave_makers = {makerOf(Side::kMinusX, 0.0), makerOf(Side::kPlusZ, 0.0)};
  WaterSim& water = make(scene);
  for (int k = 0; k < 100; ++k) water.step();
  const StateCopy state = water.copyState();
  EXPECT_TRUE(std::ranges::all_of(state.elevation_m, [](double v) { return v == 0.0; }));
  EXPECT_TRUE(std::ranges::all_of(state.flow_m2ps, [](float v) { return v == 0.0f; }));
  EXPECT_EQ(water.health().outflow_units, 0);
}

TEST_P(WaveMakersOnDevice, AtAllFourSidesKeepTheVolumeToTheUnit) {
  core::Scene scene = basin();
  scene.wave_makers = {makerOf(Side::kMinusX, 0.2),
                       makerOf(Side::kPlusX, 0.1, 2.5),
                       makerOf(Side::kMinusZ, 0.15),
                       {.side = Side::kPlusZ, .waves = core::SolitaryWave{.height_m = 0.2}}};
  WaterSim& water = make(scene);
  bool has_exchanged = false;
  for (int k = 0; k < 300; ++k) {
    water.step();
    ASSERT_EQ(water.health().volume_error_units, 0) << "tick " << k;
    has_exchanged = has_exchanged || water.health().outflow_units != 0;
  }
  EXPECT_TRUE(has_exchanged);
  EXPECT_GT(highest(water.copyState()), 0.02);
  EXPECT_EQ(water.recoveredCount(), 0u);
  EXPECT_EQ(water.nonfiniteCount(), 0u);
}

TEST_P(WaveMakersOnDevice, RepeatBitForBitAndBeginAgainAfterAReset) {
  core::Scene scene = basin();
  scene.wave_makers = {
      {.side = Side::kMinusX, .waves = core::IrregularWaves{.significant_height_m = 0.1, .peak_period_s = 3.0}}};
  std::uint64_t hashes[3];
  for (std::uint64_t& hash : hashes) {
    const bool is_reset = &hash == &hashes[2];
    WaterSim& water = is_reset ? *sim_ : make(scene);
    if (is_reset) water.reset();
    for (int k = 0; k < 120; ++k) water.step();
    hash = water.stateHash();
  }
  EXPECT_EQ(hashes[0], hashes[1]);
  EXPECT_EQ(hashes[0], hashes[2]) << "after a reset";
}

TEST_P(WaveMakersOnDevice, GoOnAtAnotherFidelityWhereTheyWere) {
  core::Scene scene = basin();
  scene.wave_makers = {makerOf(Side::kMinusX, 0.06)};
  scene.gauges = {{.name = "g", .x_m = -3.0, .z_m = 0.0}};
  WaterSim& coarse = make(scene);
  for (int k = 0; k < 300; ++k) coarse.step();
  const CarriedState carried = coarse.carriedState();
  core::Scene finer = scene;
  finer.wave->resolution_count = 72;
  auto made = WaterSim::create(*ctx_, finer);
  ASSERT_TRUE(made) << made.error().message;
  const auto taken = (*made)->takeOver(carried);
  ASSERT_TRUE(taken) << taken.error().message;
  EXPECT_NEAR((*made)->time_s(), coarse.time_s(), 1e-9);
  for (int k = 0; k < 60; ++k) {
    coarse.step();
    (*made)->step();
    ASSERT_EQ((*made)->health().volume_error_units, 0);
    // Flows of nonlinear water are carried, too, so both continue alike; half a period later they still agree.
    ASSERT_NEAR((*made)->gauges()->now()[0].reading.elevation_m, coarse.gauges()->now()[0].reading.elevation_m,
                k < 8 ? 1.0 : 0.015)
        << "tick " << k;
  }
  core::Scene other = scene;
  other.wave_makers[0] = makerOf(Side::kMinusX, 0.1);
  auto changed = WaterSim::create(*ctx_, other);
  ASSERT_TRUE(changed);
  EXPECT_FALSE((*changed)->takeOver(carried)) << "other waves are another water";
}

INSTANTIATE_TEST_SUITE_P(Waves, WaveMakersOnDevice,
                         ::testing::Combine(::testing::Values(Bulk::kLinear, Bulk::kNonlinear),
                                            ::testing::Values(Dispersion::kNone, Dispersion::kAiry)),
                         [](const auto& kind) {
                           return std::string(std::get<0>(kind.param) == Bulk::kLinear ? "Linear" : "Nonlinear") +
                                  (std::get<1>(kind.param) == Dispersion::kAiry ? "Dispersed" : "Long");
                         });

class ExtremeMakers : public OnDevice, public ::testing::WithParamInterface<bool> {};

/// The highest waves that a scene may ask for, in shallow water with a dry shore at the maker's side.
TEST_P(ExtremeMakers, NeverTakeMoreThanACellHoldsAndKeepTheVolume) {
  core::Scene scene = basinOf(Bulk::kNonlinear, GetParam() ? Dispersion::kAiry : Dispersion::kNone);
  scene.beaches = {core::Beach{Side::kPlusZ, 8.0, -0.6}};
  core::ElevationSeries jumps;
  for (int k = 0; k < 400; ++k) {
    jumps.time_s.push_back(0.05 * k);
    jumps.elevation_m.push_back(k % 14 < 7 ? 0.78 : -0.78);
  }
  scene.wave_makers = {{.side = Side::kMinusX, .waves = jumps}, makerOf(Side::kPlusX, 0.78, 8.0)};
  WaterSim& water = make(scene);
  for (int k = 0; k < 400; ++k) {
    if (k % 40 == 0) {
      ASSERT_TRUE(water.start(core::Splash{.x_m = -5, .z_m = -4, .radius_m = 2.0, .depth_m = 0.9, .duration_s = 0.05}));
    }
    water.step();
    ASSERT_EQ(water.health().volume_error_units, 0) << "tick " << k;
    if (k % 9 == 0) {
      ASSERT_GE(leastHeldUnits(water), 0) << "tick " << k;
    }
  }
  EXPECT_EQ(water.recoveredCount(), 0u);
  EXPECT_EQ(water.nonfiniteCount(), 0u);
}

TEST_P(ExtremeMakers, StayBoundedBesideMatchedLayers) {
  core::Scene scene = basinOf(Bulk::kNonlinear, GetParam() ? Dispersion::kAiry : Dispersion::kNone);
  scene.wave->boundary_minus_z = scene.wave->boundary_plus_z = WaveBoundary::kAbsorb;
  scene.wave->absorption = core::Absorption::kPml;
  scene.wave->sponge_width_m = 2.0;
  scene.wave_makers = {makerOf(Side::kMinusX, 0.2), makerOf(Side::kPlusX, 0.2)};
  WaterSim& water = make(scene);
  for (int k = 0; k < 900; ++k) {
    water.step();
    ASSERT_EQ(water.health().volume_error_units, 0) << "tick " << k;
  }
  EXPECT_LT(highest(water.copyState()), 0.5);
  EXPECT_GT(highest(water.copyState()), 0.03);
}

INSTANTIATE_TEST_SUITE_P(Waves, ExtremeMakers, ::testing::Values(false, true),
                         [](const auto& kind) { return kind.param ? "Dispersed" : "Long"; });

}  // namespace
}  // namespace spindrift::sim
