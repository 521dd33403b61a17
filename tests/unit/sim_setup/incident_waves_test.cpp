// What wave-makers let in: heights, flows, spectra, and the answer of a side.
#include <cmath>
#include <complex>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <spindrift/sim_setup/incident_waves.h>
#include <spindrift/sim_setup/sea_state.h>

#include "side_response.h"

namespace spindrift::sim {
namespace {

using std::numbers::pi;

core::Scene flume(core::Bulk bulk, core::Dispersion dispersion) {
  core::Scene scene;
  scene.wave.emplace();
  scene.wave->resolution_count = 200;
  scene.wave->side_m = 20.0;
  scene.wave->width_m = 0.8;
  scene.wave->depth_m = 1.0;
  scene.wave->bulk = bulk;
  scene.wave->dispersion = dispersion;
  setBoundaries(*scene.wave, core::WaveBoundary::kReflect);
  return scene;
}

IncidentWaves madeBy(core::Scene scene, core::WaveMaker maker) {
  scene.wave_makers = {maker};
  const auto derived = derive(scene);
  if (!derived) throw std::runtime_error(derived.error().message);
  return IncidentWaves::of(maker, scene, *derived->wave, scene.wave->depth_m);
}

TEST(SideAnswer, LongWavesAnswerWithTheirSpeed) {
  constexpr double kCell_m = 0.05, kStep_s = 0.005;
  const SideResponse side(9.81, 1.0, kCell_m, kStep_s, false);
  const auto answer = side.at(2 * pi / 20.0);
  ASSERT_TRUE(answer);
  EXPECT_NEAR(answer->flow_mps, std::sqrt(9.81), 1e-3);
  // A maker sees the level without half of its own part.
  const std::complex<double> level = answer->edge + 0.5 * kStep_s / kCell_m * answer->flow_mps;
  EXPECT_NEAR(std::abs(level - 1.0), 0.0, 0.02);
  EXPECT_NEAR(level.real(), side.longEdge() + 0.5 * kStep_s / kCell_m * std::sqrt(9.81), 1e-3);
  EXPECT_NEAR(answer->absorbing_mps, side.longAbsorbing_mps(), 0.03);
  EXPECT_LT(answer->sent_back, 0.01);
  EXPECT_FALSE(side.at(1e4)) << "no such wave on this grid";
}

TEST(SideAnswer, DispersedWavesAnswerWithTheirGroupSpeed) {
  constexpr double kCell_m = 0.01, kStep_s = 0.0001;
  const SideResponse side(9.81, 1.0, kCell_m, kStep_s, true);
  for (const double kd : {0.3, 1.0, 3.0}) {
    const double omega = waveFrequency(kd, 9.81, 1.0);
    const auto answer = side.at(omega);
    ASSERT_TRUE(answer) << kd;
    const double group_mps = 0.5 * omega / kd * (1 + 2 * kd / std::sinh(2 * kd));
    EXPECT_NEAR(answer->flow_mps / group_mps, 1.0, 0.002) << kd;
    EXPECT_NEAR((answer->edge + 0.5 * kStep_s / kCell_m * answer->flow_mps).real(), 1.0, 0.005) << kd;
    // The level that stays at the side grows with the logarithm of depth over cell.
    EXPECT_LT(answer->sent_back, 0.6) << kd;
  }
}

TEST(SideAnswer, ForcedWaveTendsToTheFreeOne) {
  const SideResponse side(9.81, 1.0, 0.05, 0.005, true);
  const double omega = waveFrequency(1.0, 9.81, 1.0);
  const auto answer = side.at(omega);
  ASSERT_TRUE(answer);
  EXPECT_NEAR(side.forcedFlow_mps(omega, 1.001 * answer->wavenumber_radpm) / answer->flow_mps, 1.0, 2e-3);
  // Without dispersion all waves move their water with their own speed.
  const SideResponse shallow(9.81, 1.0, 0.01, 0.0005, false);
  EXPECT_NEAR(shallow.forcedFlow_mps(omega, 0.5), omega / 0.5, 0.01 * omega / 0.5);
}

TEST(IncidentWaves, RegularWavesHaveTheirSecondHarmonic) {
  const core::RegularWaves waves{.height_m = 0.04, .period_s = 2.857};
  const auto harmonicOf = [&](core::Bulk bulk, int n) {
    const IncidentWaves made = madeBy(flume(bulk, core::Dispersion::kAiry), {.waves = waves});
    std::complex<double> sum;
    constexpr int kCount = 400;
    for (int k = 0; k < kCount; ++k) {
      const double t = waves.period_s * (3 + static_cast<double>(k) / kCount);
      sum += made.at(t).flow_m2ps * std::polar(2.0 / kCount, -2 * pi * n * k / kCount);
    }
    return sum;
  };
  EXPECT_LT(std::abs(harmonicOf(core::Bulk::kLinear, 2)), 1e-9);
  const std::complex<double> first = harmonicOf(core::Bulk::kNonlinear, 1);
  const std::complex<double> second = harmonicOf(core::Bulk::kNonlinear, 2);
  EXPECT_GT(std::abs(second), 0.01 * std::abs(first));
  EXPECT_LT(std::abs(second), 0.25 * std::abs(first));
  // Its crests are on those of the wave.
  EXPECT_NEAR(std::arg(second / (first * first)), 0.0, 1e-3);
}

TEST(IncidentWaves, ZeroHeightGivesNoFlow) {
  for (const auto bulk : {core::Bulk::kLinear, core::Bulk::kNonlinear}) {
    for (const auto& waves : std::vector<decltype(core::WaveMaker::waves)>{
             core::RegularWaves{.height_m = 0.0}, core::IrregularWaves{.significant_height_m = 0.0},
             core::SolitaryWave{.height_m = 0.0}, core::ElevationSeries{{0, 5}, {0, 0}}}) {
      const IncidentWaves made = madeBy(flume(bulk, core::Dispersion::kAiry), {.waves = waves});
      for (double t = 0; t < 30; t += 0.37) {
        EXPECT_EQ(made.at(t).elevation_m, 0.0);
        EXPECT_EQ(made.at(t).flow_m2ps, 0.0);
      }
    }
  }
}

TEST(IncidentWaves, BeginWithoutAJumpAndEndAgain) {
  const core::WaveMaker maker{
      .begin_s = 2.0, .duration_s = 20.0, .waves = core::RegularWaves{.height_m = 0.1, .period_s = 3.0}};
  const IncidentWaves made = madeBy(flume(core::Bulk::kNonlinear, core::Dispersion::kAiry), maker);
  double before_m = 0.0, highest_m = 0.0;
  for (double t = 0; t < 40; t += 0.01) {
    const Incident now = made.at(t);
    EXPECT_LT(std::abs(now.elevation_m - before_m), 0.003) << t;
    if (t <= 2.0 || t >= 25.0) {
      EXPECT_EQ(now.elevation_m, 0.0) << t;
    }
    before_m = now.elevation_m;
    highest_m = std::max(highest_m, now.elevation_m);
  }
  EXPECT_NEAR(highest_m, 0.05, 0.015) << "with the part that stays beside the maker and the second harmonic";
}

TEST(IncidentWaves, SpectrumHasItsHeightAndRepeatsBySeed) {
  const core::Scene scene = flume(core::Bulk::kNonlinear, core::Dispersion::kNone);
  const auto of = [&](std::uint64_t seed) {
    return madeBy(scene,
                  {.waves = core::IrregularWaves{.significant_height_m = 0.1, .peak_period_s = 4.0, .seed = seed}});
  };
  const IncidentWaves made = of(3);
  double sum = 0.0, count = 0.0;
  for (double t = 10; t < 8000; t += 0.4, count += 1) sum += made.at(t).elevation_m * made.at(t).elevation_m;
  // The level of a simple wave, without half of the maker's own part.
  const auto derived = derive(scene);
  ASSERT_TRUE(derived);
  const double seen = 1 - 0.5 * derived->wave->dt_s / derived->wave->cell_m * std::sqrt(9.81);
  EXPECT_NEAR(4 * std::sqrt(sum / count) / seen, 0.1, 0.004);
  EXPECT_EQ(made.at(77.7).elevation_m, of(3).at(77.7).elevation_m);
  EXPECT_NE(made.at(77.7).elevation_m, of(4).at(77.7).elevation_m);
}

TEST(IncidentWaves, SolitaryWaveBringsItsVolumeOnce) {
  const core::Scene scene = flume(core::Bulk::kNonlinear, core::Dispersion::kAiry);
  for (const double height_m : {0.05, 0.3}) {
    const IncidentWaves made = madeBy(scene, {.waves = core::SolitaryWave{.height_m = height_m}});
    double volume_m2 = 0.0, highest_m2ps = 0.0;
    for (double t = -20; t < 60; t += 0.01) {
      volume_m2 += 0.01 * made.at(t).flow_m2ps;
      highest_m2ps = std::max(highest_m2ps, made.at(t).flow_m2ps);
    }
    // The integral of H sech^2(x sqrt(3 H / (4 d^2 (d + H)))).
    EXPECT_NEAR(volume_m2 / (2 * height_m / std::sqrt(0.75 * height_m / (1 + height_m))), 1.0, 0.01) << height_m;
    EXPECT_NEAR(highest_m2ps / (height_m * std::sqrt(9.81 * (1 + height_m))), 1.0, 0.15) << height_m;
  }
}

TEST(IncidentWaves, SeriesIsFollowedWithoutDispersion) {
  const core::ElevationSeries series{{0, 1, 2, 4}, {0, 0.1, -0.05, 0}};
  const IncidentWaves made =
      madeBy(flume(core::Bulk::kNonlinear, core::Dispersion::kNone), {.begin_s = 3, .waves = series});
  EXPECT_EQ(made.at(2.9).elevation_m, 0.0);
  EXPECT_EQ(made.at(7.1).elevation_m, 0.0);
  const double h = 1.1;
  EXPECT_NEAR(made.at(4.0).flow_m2ps, h * 2 * (std::sqrt(9.81 * h) - std::sqrt(9.81)), 0.01) << "a simple wave";
  EXPECT_NEAR(made.at(5.5).flow_m2ps, 0.9625 * 2 * (std::sqrt(9.81 * 0.9625) - std::sqrt(9.81)), 0.01);
  EXPECT_GT(made.at(4.0).elevation_m, 0.07);
  EXPECT_LT(made.at(4.0).elevation_m, 0.1) << "without half of what the maker lets in";
}

TEST(IncidentWaves, AreFiniteWhateverTheNumbers) {
  for (const double height_m : {1e-9, 0.78}) {
    for (const auto dispersion : {core::Dispersion::kNone, core::Dispersion::kAiry}) {
      core::Scene scene = flume(core::Bulk::kNonlinear, dispersion);
      for (const auto& waves : std::vector<decltype(core::WaveMaker::waves)>{
               core::SolitaryWave{.height_m = height_m}, core::ElevationSeries{{0, 1e-6, 86400}, {0.7, -0.7, 0.7}}}) {
        const IncidentWaves made = madeBy(scene, {.waves = waves});
        for (double t = -1; t < 90000; t += 97.1) {
          EXPECT_TRUE(std::isfinite(made.at(t).elevation_m) && std::isfinite(made.at(t).flow_m2ps));
        }
      }
    }
  }
  core::Scene weightless = flume(core::Bulk::kNonlinear, core::Dispersion::kNone);
  weightless.gravity_mps2 = 0.0;
  const IncidentWaves made = madeBy(weightless, {.waves = core::RegularWaves{}});
  EXPECT_EQ(made.at(5.0).elevation_m, 0.0) << "no waves without gravity";
  EXPECT_EQ(made.absorbing_mps(), 0.0);
}

TEST(MakerRules, NameWavesThatTheGridOrTheWaterCannotHave) {
  const auto messageOf = [](core::WaveMaker maker, auto change) {
    core::Scene scene = flume(core::Bulk::kNonlinear, core::Dispersion::kAiry);
    scene.wave_makers = {std::move(maker)};
    change(scene);
    const auto derived = derive(scene);
    return derived ? std::string() : derived.error().message;
  };
  const auto same = [](core::Scene&) {};
  EXPECT_EQ(messageOf({.waves = core::RegularWaves{}}, same), "");
  EXPECT_NE(messageOf({.waves = core::RegularWaves{.height_m = 0.01, .period_s = 0.5}}, same)
                .find("wave_makers[0].regular.period_s: waves of 0.5 s are"),
            std::string::npos);
  EXPECT_NE(messageOf({.waves = core::RegularWaves{.height_m = 0.5, .period_s = 1.0}}, same).find("break at once"),
            std::string::npos);
  EXPECT_NE(messageOf({.waves = core::IrregularWaves{.significant_height_m = 0.2, .peak_period_s = 1.0}}, same)
                .find("wave_makers[0].irregular: waves of 1 s and 0.2 m break at once"),
            std::string::npos);
  EXPECT_NE(messageOf({.side = core::Side::kPlusX, .waves = core::RegularWaves{}},
                      [](core::Scene& scene) {
                        scene.beaches = {core::Beach{core::Side::kPlusX, 10.0, -0.5}};
                      })
                .find("wave_makers[0].side: all of this side is dry"),
            std::string::npos);
}

}  // namespace
}  // namespace spindrift::sim
