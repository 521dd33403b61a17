#include <cmath>

#include <gtest/gtest.h>

#include <spindrift/effects/effects.h>
#include <spindrift/sim_setup/pulse.h>

#include "small_scene.h"

namespace spindrift::sim {
namespace {

WaveLayout layout() {
  const auto d = derive(smallScene());
  return *d->wave;
}

TEST(Pulse, RisesSmoothlyFromZeroToOne) {
  EXPECT_EQ(pulse(-1), 0);
  EXPECT_EQ(pulse(0), 0);
  EXPECT_EQ(pulse(1), 1);
  EXPECT_EQ(pulse(5), 1);
  for (int k = 0; k < 100; ++k) EXPECT_LE(pulse(0.01 * k), pulse(0.01 * (k + 1)));
  EXPECT_LT(pulse(1e-3), 1e-5) << "no jump at the start";
}

TEST(Effects, SharesOfAPulseSumToItsAmplitude) {
  const WaveLayout wave = layout();
  for (const double duration_s : {0.02, 0.2, 0.35}) {
    Effects effects;
    ASSERT_TRUE(effects.start(core::Splash{0, 0, 1, 0.5, duration_s}, 1.0));
    double sum = 0;
    int steps = 0;
    for (double t = 1.0; !effects.idle() && steps < 1000; t += wave.dt_s, ++steps) {
      const auto u = effects.advance(t, domainOf(wave));
      for (std::uint32_t k = 0; k < u.splash_count; ++k) sum += u.splashes[k].gain_m;
    }
    EXPECT_NEAR(sum, -0.5, 1e-6);
    EXPECT_TRUE(effects.idle());
  }
}

TEST(Effects, RefuseMoreThanTheirBound) {
  Effects effects;
  for (int k = 0; k < MAX_SPLASHES; ++k) ASSERT_TRUE(effects.start(core::Splash{}, 0));
  const auto refused = effects.start(core::Splash{}, 0);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, core::ErrorCode::kUnavailable);
  EXPECT_TRUE(effects.start(core::BreakingWave{.side = core::Side::kMinusX}, 0)) << "waves have their own places";
}

TEST(Effects, ShortCrestHasTheSpeedOfItsWaves) {
  EffectDomain domain{.side_x_m = 40, .side_z_m = 40, .cell_m = 0.1, .speed_mps = std::sqrt(9.81 * 2), .dt_s = 0.01};
  const auto speed = [&](double length_m) {
    Effects effects;
    core::BreakingWave wave{core::Side::kMinusX, 0.3, length_m, 1.0};
    wave.shape = core::WaveShape::kSwell;
    EXPECT_TRUE(effects.start(wave, 0.0));
    return effects.advance(0.0, domain).crests[0].speed_mps;
  };
  EXPECT_FLOAT_EQ(speed(1.0), static_cast<float>(domain.speed_mps)) << "without dispersion";
  domain.dispersing_depth_m = 2.0;
  // Full width at half height 1.763 w; k = 0.894/w, so 1.577 rad/m for 1 m and tanh(3.15)/3.15 = 0.3162.
  EXPECT_NEAR(speed(1.0) / domain.speed_mps, std::sqrt(0.3162), 0.002);
  EXPECT_NEAR(speed(60.0) / domain.speed_mps, 1.0, 1e-3) << "long waves do not disperse";
}

TEST(Effects, CrestTravelsInwardsFromItsSide) {
  const WaveLayout wave = layout();
  Effects effects;
  ASSERT_TRUE(effects.start(core::BreakingWave{core::Side::kPlusX, 0.5, 1.0, 1.0}, 0.0));
  const auto first = effects.advance(0.0, domainOf(wave)).crests[0];
  EXPECT_EQ(first.direction_x, -1.0f) << "from +x it travels towards -x";
  EXPECT_LT(first.offset_m, 0.0f);
  const auto later = effects.advance(0.5, domainOf(wave)).crests[0];
  EXPECT_NEAR(later.offset_m - first.offset_m, 0.5 * wave.speed_mps, 1e-5);
}

}  // namespace
}  // namespace spindrift::sim
