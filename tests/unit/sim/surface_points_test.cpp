// The surface at points: equal to gauges and frames of the same tick, and to known water.
#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "seiche.h"

namespace spindrift::sim {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

class SurfacePointsOnDevice : public SeicheOnDevice {
 protected:
  SurfaceSamples samplesAt(WaterSim& sim, const std::vector<SurfacePoint>& points) {
    const auto begun = sim.sampleAt(points, 7);
    EXPECT_TRUE(begun && *begun);
    ctx_->finish();
    std::vector<SurfaceSamples> taken = sim.takeSamples();
    EXPECT_EQ(taken.size(), 1u);
    EXPECT_EQ(sim.samplesInFlight(), 0u);
    if (taken.empty()) return {.number = 0, .samples = std::vector<SurfaceSample>(points.size()), .outside = {}};
    EXPECT_EQ(taken.front().number, 7u);
    return std::move(taken.front());
  }
  core::FrameView frameOf(WaterSim& sim) {
    EXPECT_TRUE(sim.requestFrame(FrameRequest::full({.surface = true, .foam = true})));
    ctx_->finish();
    std::vector<core::FrameView> frames = sim.takeFrames();
    EXPECT_EQ(frames.size(), 1u);
    return frames.empty() ? core::FrameView() : std::move(frames.front());
  }
};

/// Points on a spiral over the whole water, centres of cells and edges among them.
std::vector<SurfacePoint> spiral(double side_m, int count) {
  std::vector<SurfacePoint> out = {{0, 0}, {-side_m / 2, -side_m / 2}, {side_m / 2, side_m / 2}, {side_m / 2, 0}};
  for (int k = 0; k < count; ++k) {
    const double reach_m = 0.5 * side_m * k / count;
    out.push_back({reach_m * std::cos(0.7 * k), reach_m * std::sin(0.7 * k)});
  }
  return out;
}

/// Value between the samples of a plane, bilinear; beyond the outermost sample as there, or across periodic sides.
double between(std::span<const double> values, core::CellCounts count, double side_m, SurfacePoint at, bool periodic) {
  const double column = (at.x_m / side_m + 0.5) * count.x - 0.5, row = (at.z_m / side_m + 0.5) * count.z - 0.5;
  const auto value = [&](double i, double k) {
    const auto cell = [&](double c, std::uint32_t n) {
      const int wanted = static_cast<int>(c), last = static_cast<int>(n) - 1;
      if (periodic) return static_cast<std::size_t>((wanted + last + 1) % (last + 1));
      return static_cast<std::size_t>(std::clamp(wanted, 0, last));
    };
    return values[cell(i, count.x) + count.x * cell(k, count.z)];
  };
  const double i = std::floor(column), k = std::floor(row), u = column - i, v = row - k;
  return (1 - v) * ((1 - u) * value(i, k) + u * value(i + 1, k)) +
         v * ((1 - u) * value(i, k + 1) + u * value(i + 1, k + 1));
}

/// The picture of the same tick, without and with periodic sides, with 5 and 9 points, and with foam.
TEST_F(SurfacePointsOnDevice, AgreeWithTheFrameOfTheSameTickToAQuantum) {
  for (const bool is_periodic : {false, true}) {
    core::Scene scene = smallScene();
    scene.particles.reset();
    scene.coupling.reset();
    scene.foam->surface = true;
    scene.wave->resolution_count = 63;
    scene.wave->stencil = is_periodic ? core::Stencil::kNinePoint : core::Stencil::kFivePoint;
    setBoundaries(*scene.wave, is_periodic ? core::WaveBoundary::kPeriodic : core::WaveBoundary::kReflect);
    WaterSim& sim = make(scene);
    ASSERT_TRUE(sim.start(core::Splash{0.5, 0.5, 1.0, 1.0, 0.1}));
    for (int tick = 0; tick < 30; ++tick) sim.step();
    const std::vector<SurfacePoint> points = spiral(8.0, 300);
    const SurfaceSamples samples = samplesAt(sim, points);
    const core::FrameView frame = frameOf(sim);
    EXPECT_EQ(frame.tick, sim.tick());
    const auto& surface = *frame.at(core::Level::kFull).surface;
    const auto& foam = *frame.at(core::Level::kFull).foam;
    std::vector<double> heights_m, whites;
    for (std::size_t k = 0; k < surface.count.total(); ++k) {
      const auto word = static_cast<std::uint16_t>(surface.words[k / 2] >> (k % 2 * 16));
      heights_m.push_back(static_cast<std::int16_t>(word) * surface.quantum_m);
    }
    for (std::size_t k = 0; k < foam.count.total(); ++k)
      whites.push_back((foam.words[k / 4] >> (k % 4 * 8) & 0xffu) / 255.0);
    EXPECT_GT(*std::ranges::max_element(whites), 0.2) << "there is foam";
    EXPECT_GT(*std::ranges::max_element(heights_m), 0.05) << "the surface is not flat";
    for (std::size_t k = 0; k < points.size(); ++k) {
      EXPECT_NEAR(samples.samples[k].elevation_m, between(heights_m, surface.count, 8.0, points[k], is_periodic),
                  0.51 * surface.quantum_m)
          << k;
      EXPECT_NEAR(samples.samples[k].foam_ratio, between(whites, foam.count, 8.0, points[k], is_periodic), 0.51 / 255)
          << k;
      EXPECT_EQ(samples.samples[k].wet_ratio, 1.0F);
    }
  }
}

TEST_F(SurfacePointsOnDevice, ReadWhatGaugesRead) {
  core::Scene scene = seicheScene();
  scene.wave->bulk = core::Bulk::kNonlinear;
  scene.beaches = {core::Beach{core::Side::kPlusX, 6.0, -0.5}};
  std::vector<SurfacePoint> points = spiral(kPoolSide_m, 50);
  for (const SurfacePoint& at : points) scene.gauges.push_back({.name = "g", .x_m = at.x_m, .z_m = at.z_m});
  WaterSim& sim = make(scene);
  ASSERT_TRUE(sim.start(core::Splash{-2, 0.5, 1.0, 1.0, 0.2}));
  for (int tick = 0; tick < 40; ++tick) sim.step();
  const SurfaceSamples samples = samplesAt(sim, points);
  const double time_s = sim.time_s();
  for (int tick = 0; tick < 8; ++tick) sim.step();
  int moving_count = 0, dry_count = 0;
  for (std::size_t g = 0; g < points.size(); ++g) {
    const GaugeHistory::Series series = sim.gauges()->series(g);
    const auto at = std::ranges::lower_bound(series.time_s, time_s - 1e-9) - series.time_s.begin();
    ASSERT_LT(static_cast<std::size_t>(at), series.time_s.size());
    const GaugeReading& reading = series.readings[static_cast<std::size_t>(at)];
    EXPECT_FLOAT_EQ(samples.samples[g].elevation_m, reading.elevation_m) << g;
    EXPECT_NEAR(samples.samples[g].velocity_x_mps, reading.velocity_x_mps, 1e-6) << g;
    EXPECT_NEAR(samples.samples[g].velocity_z_mps, reading.velocity_z_mps, 1e-6) << g;
    moving_count += std::abs(reading.velocity_x_mps) > 1e-3 ? 1 : 0;
    dry_count += samples.samples[g].wet_ratio == 0.0F ? 1 : 0;
  }
  EXPECT_GT(moving_count, 20);
  EXPECT_GT(dry_count, 0);
}

TEST_F(SurfacePointsOnDevice, KnowSlopeAndVerticalSpeedOfAStandingWave) {
  WaterSim& sim = make(seicheScene());
  startSeiche(sim);
  for (int tick = 0; tick < 37; ++tick) sim.step();
  const std::vector<SurfacePoint> points = {{-3.3, 1.3}, {0.17, -2}, {2.0, 0.4}};
  const SurfaceSamples samples = samplesAt(sim, points);
  const double k_radpm = wavenumber_radpm();
  const double omega_radps = k_radpm * std::sqrt(sim.scene().gravity_mps2 * sim.scene().wave->depth_m);
  const double t_s = sim.time_s();
  for (std::size_t p = 0; p < points.size(); ++p) {
    const double phase = k_radpm * (points[p].x_m + kPoolSide_m / 2);
    const SurfaceSample& at = samples.samples[p];
    EXPECT_NEAR(at.slope_x, -kAmplitude_m * k_radpm * std::sin(phase) * std::cos(omega_radps * t_s),
                0.005 * kAmplitude_m * k_radpm);
    EXPECT_NEAR(at.slope_z, 0.0, 1e-6);
    // Flows belong to half a wave step before the elevations.
    EXPECT_NEAR(
        at.vertical_speed_mps,
        -kAmplitude_m * omega_radps * std::cos(phase) * std::sin(omega_radps * (t_s - sim.derived().wave->dt_s / 2)),
        0.005 * kAmplitude_m * omega_radps);
    EXPECT_NEAR(at.depth_m, sim.scene().wave->depth_m + at.elevation_m, 1e-5);
  }
}

/// A beach from 1.5 m of depth at x = 0 to 0.5 m above the water at x = 6.
TEST_F(SurfacePointsOnDevice, KnowDepthAndDryGroundOfABeach) {
  for (const core::Bulk bulk : {core::Bulk::kLinear, core::Bulk::kNonlinear}) {
    core::Scene scene = seicheScene();
    scene.wave->bulk = bulk;
    scene.beaches = {core::Beach{core::Side::kPlusX, 6.0, -0.5}};
    WaterSim& sim = make(scene);
    for (int tick = 0; tick < 3; ++tick) sim.step();
    const SurfaceSamples samples = samplesAt(sim, {{-3, 0}, {3, 0}, {5.4, 0}, {4.5, 0}});
    EXPECT_NEAR(samples.samples[0].depth_m, 1.5, 0.01);
    EXPECT_NEAR(samples.samples[1].depth_m, 0.5, 0.02);
    EXPECT_EQ(samples.samples[1].wet_ratio, 1.0F);
    EXPECT_EQ(samples.samples[2].depth_m, 0.0F);
    EXPECT_EQ(samples.samples[2].wet_ratio, 0.0F);
    EXPECT_NEAR(samples.samples[2].elevation_m, bulk == core::Bulk::kNonlinear ? 0.3 : 0.0, 0.02);
    EXPECT_LT(samples.samples[3].depth_m, 0.05);
    EXPECT_NEAR(samples.samples[3].slope_x, 0.0, 1e-3) << "the water lies level up to its edge";
    EXPECT_THAT(samples.outside, IsEmpty());
  }
}

TEST_F(SurfacePointsOnDevice, OutsideOfTheWaterAreNamedAndZero) {
  WaterSim& sim = make(seicheScene());
  startSeiche(sim);
  sim.step();
  const double edge_m = kPoolSide_m / 2;
  const SurfaceSamples samples = samplesAt(sim, {{-edge_m, 0}, {-edge_m - 0.01, 0}, {0, edge_m}, {1e30, -1e30}});
  EXPECT_THAT(samples.outside, ElementsAre(1u, 3u));
  EXPECT_NE(samples.samples[0].elevation_m, 0.0F);
  for (const std::size_t k : {1u, 3u}) {
    EXPECT_EQ(samples.samples[k].elevation_m, 0.0F);
    EXPECT_EQ(samples.samples[k].depth_m, 0.0F);
    EXPECT_EQ(samples.samples[k].wet_ratio, 0.0F);
  }
}

TEST_F(SurfacePointsOnDevice, ChangeNothingInTheWaterAndCostOneDispatchWhenAskedFor) {
  const std::vector<SurfacePoint> points = spiral(kPoolSide_m, 1000);
  const auto run40 = [&](bool asks) {
    WaterSim& sim = make(seicheScene());
    startSeiche(sim);
    const std::uint64_t before = ctx_->ledger().dispatch_count;
    for (int k = 0; k < 40; ++k) {
      sim.step();
      if (asks) samplesAt(sim, points);
    }
    return std::pair(sim.stateHash(), ctx_->ledger().dispatch_count - before);
  };
  const auto without = run40(false);
  const auto with = run40(true);
  EXPECT_EQ(with.first, without.first);
  EXPECT_EQ(with.second, without.second + 40);
}

TEST_F(SurfacePointsOnDevice, AreRefusedWhileAllSlotsAreInUseAndWithoutAWave) {
  WaterSim& sim = make(seicheScene());
  const std::vector<SurfacePoint> points = {{0, 0}};
  std::uint64_t number = 0;
  while (*sim.sampleAt(points, ++number) && number < 100) {
  }
  EXPECT_EQ(sim.samplesInFlight(), number - 1);
  EXPECT_LE(number, 16u);
  ctx_->finish();
  const std::vector<SurfaceSamples> taken = sim.takeSamples();
  ASSERT_EQ(taken.size(), number - 1);
  EXPECT_EQ(taken.back().number, number - 1);
  EXPECT_TRUE(*sim.sampleAt(points, number));
  core::Scene box;
  box.particles.emplace();
  const auto none = make(box).sampleAt(points, 1);
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message, testing::HasSubstr("no wave"));
}

}  // namespace
}  // namespace spindrift::sim
