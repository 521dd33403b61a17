// Comparison of runs, and the front of cost against error.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <spindrift/sim_setup/derive.h>
#include <spindrift/study/trade.h>
#include <spindrift/study/water_record.h>

#include "test_device.h"

namespace spindrift::study {
namespace {

core::Scene waveOnly() {
  core::Scene scene;
  scene.name = "wave";
  scene.wave.emplace();
  return scene;
}

/// A record of one sample: `amplitude_m` cos(2 pi k x / side).
WaterRecord waves(double amplitude_m, int k) {
  WaterRecord record;
  WaterRecord::Sample sample;
  for (std::size_t z = 0; z < kSurfaceCells; ++z)
    for (std::size_t x = 0; x < kSurfaceCells; ++x)
      sample.surface_m.push_back(amplitude_m *
                                 std::cos(2 * std::numbers::pi * k * static_cast<double>(x) / kSurfaceCells));
  sample.energy_j = amplitude_m * amplitude_m;
  record.samples.push_back(sample);
  return record;
}

TEST(RecordErrors, AreZeroBetweenEqualRuns) {
  const RecordErrors errors = compare(waves(0.5, 3), waves(0.5, 3), waveOnly());
  EXPECT_EQ(errors.height_rms_ratio, 0.0);
  EXPECT_EQ(errors.surface_max_ratio, 0.0);
  EXPECT_EQ(errors.spectrum_ratio, 0.0);
  EXPECT_EQ(errors.energy_rms_ratio, 0.0);
  EXPECT_FALSE(errors.column_rms_ratio);
  EXPECT_FALSE(errors.density_rms_ratio) << "no particles";
}

TEST(RecordErrors, AreSharesOfTheReference) {
  const RecordErrors errors = compare(waves(0.6, 3), waves(0.5, 3), waveOnly());
  EXPECT_NEAR(errors.height_rms_ratio, 0.2, 1e-12);
  EXPECT_NEAR(*errors.surface_max_ratio, 0.2 * std::numbers::sqrt2, 1e-9) << "over the root mean square";
  EXPECT_NEAR(*errors.spectrum_ratio, 0.44, 1e-9) << "(0.36 - 0.25) / 0.25";
  EXPECT_NEAR(errors.energy_rms_ratio, 0.44, 1e-9);
}

TEST(RecordErrors, ShowWavesOfAnotherLengthInTheSpectrum) {
  const RecordErrors errors = compare(waves(0.5, 5), waves(0.5, 3), waveOnly());
  EXPECT_NEAR(*errors.spectrum_ratio, 2.0, 1e-9);
  EXPECT_NEAR(errors.height_rms_ratio, std::numbers::sqrt2, 1e-9);
}

TEST(ParetoFront, KeepsPointsThatNoOtherBeatsInBoth) {
  const std::vector<CostAndError> points = {{1, 10}, {2, 5}, {2, 6}, {3, 5}, {4, 1}, {1, 10}};
  EXPECT_EQ(paretoFront(points), (std::vector<bool>{true, true, false, false, true, true}));
}

TEST(ParetoFront, IgnoresDifferencesBelowItsResolution) {
  const std::vector<CostAndError> points = {{1.00, 1.00}, {1.03, 1.02}, {1.10, 1.00}};
  EXPECT_EQ(paretoFront(points, {0.05, 0.05}), (std::vector<bool>{true, true, false}));
}

TEST(SingleKnobs, ChangeOneThingEach) {
  core::Scene scene;
  scene.name = "pool";
  scene.wave.emplace();
  scene.particles.emplace();
  scene.coupling.emplace();
  const auto knobs = singleKnobs(scene);
  EXPECT_GT(knobs.size(), 15u);
  for (const TradeChoice& choice : knobs) {
    int changes = 0;
    changes += choice.scene.tick_rate_hz != scene.tick_rate_hz;
    changes += choice.scene.seed != scene.seed;
    changes += choice.scene.stream.surface_quantum_m != scene.stream.surface_quantum_m;
    changes += choice.scene.wave->resolution_count != scene.wave->resolution_count;
    changes += choice.scene.wave->stencil != scene.wave->stencil;
    if (choice.scene.particles) {
      changes += choice.scene.particles->count != scene.particles->count;
      changes += choice.scene.particles->kernel_set != scene.particles->kernel_set;
      changes += choice.scene.particles->solver != scene.particles->solver;
      changes += choice.scene.particles->pressure_force != scene.particles->pressure_force;
      changes += choice.scene.coupling->mode != scene.coupling->mode;
      changes += choice.scene.coupling->lattice_count != scene.coupling->lattice_count;
      changes += choice.scene.coupling->downforce_per_m_s2 != scene.coupling->downforce_per_m_s2;
    } else {
      ++changes;
    }
    EXPECT_EQ(changes, 1) << choice.knob << " " << choice.setting;
  }
}

TEST(SimplerWaves, LeaveOutDispersionAndTheNonlinearBulk) {
  core::Scene scene = waveOnly();
  EXPECT_TRUE(simplerWaves(scene).empty());
  scene.wave->dispersion = core::Dispersion::kAiry;
  ASSERT_EQ(simplerWaves(scene).size(), 1u);
  EXPECT_EQ(simplerWaves(scene)[0].scene.wave->dispersion, core::Dispersion::kNone);
  scene.wave->bulk = core::Bulk::kNonlinear;
  const auto choices = simplerWaves(scene);
  ASSERT_EQ(choices.size(), 3u);
  for (std::size_t i = 0; i < choices.size(); ++i) {
    EXPECT_EQ(choices[i].scene.wave->dispersion, i == 1 ? core::Dispersion::kAiry : core::Dispersion::kNone);
    EXPECT_EQ(choices[i].scene.wave->bulk, i == 0 ? core::Bulk::kNonlinear : core::Bulk::kLinear);
  }
}

TEST(FinerScenes, CanDisperse) {
  for (const std::uint32_t cells : {192u, 480u, 640u, 960u}) {
    core::Scene scene = waveOnly();
    scene.wave->dispersion = core::Dispersion::kAiry;
    scene.wave->resolution_count = cells;
    const auto derived = sim::derive(finerThan(scene, 4.0 / 3));
    EXPECT_TRUE(derived) << cells << ": " << derived.error().message;
  }
}

TEST(FinerScenes, KeepTheShapeOfARectangle) {
  core::Scene scene = waveOnly();
  scene.wave->resolution_count = 150;
  scene.wave->side_m = 24.0;
  scene.wave->width_m = 17.28;
  const auto derived = sim::derive(finerThan(scene, 1.25));
  ASSERT_TRUE(derived) << derived.error().message;
  EXPECT_GE(derived->wave->count_x, 187u);
  EXPECT_NEAR(derived->wave->width_m, 17.28, 1e-9);
}

class OnDevice : public ::testing::Test {
 protected:
  void SetUp() override {
    auto made = gpu::testContext();
    if (!made) GTEST_SKIP() << "no device: " << made.error().message;
    ctx_ = *std::move(made);
  }
  std::unique_ptr<gpu::Context> ctx_;
};

TEST_F(OnDevice, FinerRunsOfAWaveComeCloserToTheFinest) {
  const auto run = [&](std::uint32_t cells) {
    core::Scene scene = waveOnly();
    scene.wave->resolution_count = cells;
    scene.wave->side_m = 12.0;
    scene.events = {{0.0, 0.0, core::Splash{0.0, 0.0, 1.5, 0.5, 0.2}}};
    auto record = study::record(*ctx_, scene,
                                {.seconds = 1.5, .sample_interval_s = 0.1, .frame_bytes = {}, .repeat_below_s = 0.0});
    EXPECT_TRUE(record) << record.error().message;
    return record ? *std::move(record) : WaterRecord();
  };
  const WaterRecord finest = run(384);
  ASSERT_EQ(finest.samples.size(), 15u);
  EXPECT_GT(finest.cost_ms_per_s, 0.0);
  EXPECT_EQ(finest.recovered_count, 0u);
  const double coarse = compare(run(48), finest, waveOnly()).height_rms_ratio;
  const double middle = compare(run(96), finest, waveOnly()).height_rms_ratio;
  EXPECT_LE(middle, 0.5 * coarse) << "a quarter in theory, for an error of second order";
  EXPECT_GT(middle, 0.0);
}

TEST_F(OnDevice, RectanglesAreComparedAndDryLandIsLevel) {
  core::Scene scene = waveOnly();
  scene.wave->resolution_count = 128;
  scene.wave->side_m = 16.0;
  scene.wave->width_m = 4.0;
  setBoundaries(*scene.wave, core::WaveBoundary::kReflect);
  scene.wave->bulk = core::Bulk::kNonlinear;
  scene.beaches = {core::Beach{core::Side::kPlusX, 8.0, -0.5}};
  const auto run = study::record(*ctx_, scene, {.seconds = 0.1, .frame_bytes = {}, .repeat_below_s = 0.0});
  ASSERT_TRUE(run) << run.error().message;
  ASSERT_EQ(run->samples[0].surface_m.size(), kSurfaceCells * 16);
  for (const double level_m : run->samples[0].surface_m) EXPECT_NEAR(level_m, 0.0, 1e-9);
}

}  // namespace
}  // namespace spindrift::study
