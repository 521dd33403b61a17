// The closed forms that the accuracy cases compare with: their equations, boundary conditions and known limits.
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "basin_modes.h"
#include "boat_track.h"
#include "diffraction.h"
#include "exact_linear_waves.h"
#include "mild_slope.h"
#include "shallow_reference.h"
#include "shallow_water.h"
#include "wave_packet.h"

namespace spindrift::study {
namespace {

using std::numbers::pi;

TEST(AiryWater, HasTheSpeedsOfLongAndOfShortWaves) {
  const AiryWater water{9.81, 2.0};
  EXPECT_NEAR(water.phaseSpeed_mps(1e-4), std::sqrt(9.81 * 2.0), 1e-6);
  EXPECT_NEAR(water.groupSpeed_mps(1e-4), std::sqrt(9.81 * 2.0), 1e-6);
  EXPECT_NEAR(water.phaseSpeed_mps(20.0), std::sqrt(9.81 / 20.0), 1e-9);
  EXPECT_NEAR(water.groupSpeed_mps(20.0), 0.5 * std::sqrt(9.81 / 20.0), 1e-9);
}

TEST(AiryWater, GroupSpeedIsTheDerivativeOfTheFrequency) {
  const AiryWater water{9.81, 2.0};
  for (const double k : {0.05, 0.5, 1.3, 6.0}) {
    const double derivative = (water.omega_radps(k + 1e-5) - water.omega_radps(k - 1e-5)) / 2e-5;
    EXPECT_NEAR(water.groupSpeed_mps(k) / derivative, 1.0, 1e-7) << k;
  }
}

TEST(AiryWater, FindsWaveNumbers) {
  const AiryWater water{9.81, 2.0};
  for (const double k : {0.01, 0.3, 2.0, 30.0})
    EXPECT_NEAR(water.waveNumber_radpm(water.omega_radps(k)) / k, 1.0, 1e-9);
  const double k = water.stationaryWaveNumber_radpm(2.2);
  EXPECT_NEAR(water.phaseSpeed_mps(k), 2.2, 1e-9);
  EXPECT_EQ(water.stationaryWaveNumber_radpm(4.5), 0.0) << "faster than all waves";
}

TEST(AiryRings, StartAsTheHump) {
  for (const Hump hump : {Hump::kGaussian, Hump::kRicker}) {
    const AiryRings rings({9.81, 1.5}, hump, 0.8, 0.0, 6.0);
    for (const double r_m : {0.0, 0.3, 0.81, 1.7, 5.0})
      EXPECT_NEAR(rings.at(r_m), humpAt(hump, r_m / 0.8), 2e-4) << r_m;
  }
}

TEST(AiryRings, FollowDawsonsIntegralForVeryLongWaves) {
  // Without dispersion eta(0, t) = 1 - 2 q D(q), q = c t/w, D(q) = Int_0^q exp(u^2 - q^2) du.
  constexpr double kWidth_m = 400.0;
  const AiryWater water{9.81, 1.0};
  for (const double q : {0.5, 1.0, 2.0}) {
    double dawson = 0.0;
    constexpr int kPoints = 4000;
    for (int i = 0; i < kPoints; ++i) {
      const double u = q * (i + 0.5) / kPoints;
      dawson += std::exp(u * u - q * q) * q / kPoints;
    }
    const AiryRings rings(water, Hump::kGaussian, kWidth_m, q * kWidth_m / water.phaseSpeed_mps(0.0), 10.0);
    EXPECT_NEAR(rings.at(0.0), 1 - 2 * q * dawson, 1e-3) << q;
  }
}

TEST(LinearSea, SwingsUnderASuddenPressure) {
  constexpr std::size_t kSide = 16;
  const AiryWater water{9.81, 0.7};
  LinearSea sea(water, kSide, 8.0);
  std::vector<double> head_m(kSide * kSide);
  const double kx = 2 * pi * 3 / 8.0;
  const double kz = -2 * pi * 2 / 8.0;
  const auto wave = [&](std::size_t i) {
    return std::cos(kx * 0.5 * static_cast<double>(i % kSide) + kz * 0.5 * static_cast<double>(i / kSide) + 0.4);
  };
  for (std::size_t i = 0; i < head_m.size(); ++i) head_m[i] = 0.1 * wave(i) + 0.05;
  sea.advance(head_m, 1e-9);
  for (int k = 0; k < 20; ++k) sea.advance(head_m, 0.07);
  // eta = -head (1 - cos(omega t)); the mean of the head moves nothing.
  const double share = 1 - std::cos(water.omega_radps(std::hypot(kx, kz)) * 1.4);
  const std::vector<double> eta_m = sea.surface();
  for (std::size_t i = 0; i < eta_m.size(); ++i) EXPECT_NEAR(eta_m[i], -0.1 * wave(i) * share, 1e-9);
}

TEST(LinearSea, FollowsAHeadThatGrowsInTime) {
  // eta'' + omega^2 (eta + a t) = 0 from rest: eta = -a (t - sin(omega t)/omega), for any division into steps.
  constexpr std::size_t kSide = 8;
  const AiryWater water{9.81, 0.7};
  LinearSea sea(water, kSide, 4.0);
  const double k = 2 * pi / 4.0;
  std::vector<double> head_m(kSide * kSide);
  double time_s = 0.0;
  for (const double dt_s : {0.2, 0.05, 0.4}) {
    time_s += dt_s;
    for (std::size_t i = 0; i < head_m.size(); ++i)
      head_m[i] = 0.3 * time_s * std::cos(k * 0.5 * static_cast<double>(i % kSide));
    sea.advance(head_m, dt_s);
  }
  const double omega = water.omega_radps(k);
  EXPECT_NEAR(sea.surface()[0], -0.3 * (time_s - std::sin(omega * time_s) / omega), 1e-12);
}

TEST(Diffraction, FresnelIntegralHasItsKnownValues) {
  EXPECT_NEAR(std::abs(fresnelIntegral(1.0) - std::complex(0.7798934004, -0.4382591474)), 0.0, 1e-7);
  EXPECT_NEAR(std::abs(fresnelIntegral(-1.0) + fresnelIntegral(1.0)), 0.0, 1e-12);
  EXPECT_NEAR(std::abs(fresnelIntegral(40.0) - std::complex(0.5, -0.5)), 0.0, 0.01) << "1/2 - i/2 far out";
}

TEST(Diffraction, SolvesTheWaveEquationWithoutFlowThroughTheWall) {
  const double k = 3.0;
  constexpr double kStep_m = 1e-3;
  const auto at = [&](double along_m, double behind_m) { return pastBreakwaterEnd(along_m, behind_m, k); };
  for (const auto& [along_m, behind_m] : {std::pair{-2.0, 1.5}, std::pair{2.0, 1.5}, std::pair{1.2, -2.0}}) {
    const auto laplacian =
        (at(along_m + kStep_m, behind_m) + at(along_m - kStep_m, behind_m) + at(along_m, behind_m + kStep_m) +
         at(along_m, behind_m - kStep_m) - 4.0 * at(along_m, behind_m)) /
        (kStep_m * kStep_m);
    EXPECT_NEAR(std::abs(laplacian + k * k * at(along_m, behind_m)), 0.0, 1e-3);
  }
  for (const double side : {1.0, -1.0}) {
    for (const double along_m : {0.5, 2.0, 7.0}) {
      const auto slope = (at(along_m, side * 2e-4) - at(along_m, side * 1e-4)) / 1e-4;
      EXPECT_NEAR(std::abs(slope) / k, 0.0, 2e-3) << along_m << ", " << side;
    }
  }
  // One function across both lines where its form changes.
  EXPECT_NEAR(std::abs(at(1e-9, 2.0) - at(-1e-9, 2.0)), 0.0, 1e-4) << "edge of the shadow";
  EXPECT_NEAR(std::abs(at(1e-9, -2.0) - at(-1e-9, -2.0)), 0.0, 1e-4) << "edge of the reflection";
}

TEST(Diffraction, IsHalfAtTheEdgeOfTheShadow) {
  const double k = 2 * pi;
  EXPECT_NEAR(std::abs(pastBreakwaterEnd(-60.0, 4.0, k)), 1.0, 0.02);
  EXPECT_NEAR(std::abs(pastBreakwaterEnd(0.0, 200.0, k)), 0.5, 0.02);
  EXPECT_LT(std::abs(pastBreakwaterEnd(200.0, 4.0, k)), 0.02);
  // In front, the incident and the reflected wave: 2 cos(k y).
  EXPECT_NEAR(std::abs(pastBreakwaterEnd(60.0, -1.0, k)), 2.0, 0.05);
  EXPECT_NEAR(std::abs(pastBreakwaterEnd(60.0, -1.25, k)), 0.0, 0.05);
}

TEST(Diffraction, AGapLightsItsMiddleAndBothSidesAlike) {
  const double k = 2 * pi;
  EXPECT_NEAR(std::abs(behindGap(0.0, 2.0, 200.0, k)), 1.0, 0.03);
  EXPECT_NEAR(std::abs(behindGap(3.0, 2.0, 2.5, k)), std::abs(behindGap(-3.0, 2.0, 2.5, k)), 1e-12);
  EXPECT_LT(std::abs(behindGap(30.0, 1.0, 2.5, k)), 0.1);
}

TEST(MildSlope, IsAStandingWaveWhereTheBedIsLevel) {
  const SlopeToWall slope{9.81, 2.0, 2.0, 12.0};
  const double omega = 2.5;
  const double k = slope.waterAt(0.0).waveNumber_radpm(omega);
  for (const double x_m : {0.0, 3.0, 7.5, 12.0}) {
    EXPECT_NEAR(std::abs(slope.responseAt(x_m, omega).elevation), 2 * std::abs(std::cos(k * (12.0 - x_m))), 1e-5)
        << x_m;
    EXPECT_NEAR(std::abs(slope.responseAt(x_m, omega).slope_pm), 2 * k * std::abs(std::sin(k * (12.0 - x_m))), 1e-5);
  }
}

TEST(MildSlope, KeepsTheEnergyFluxOnAGentleSlope) {
  const SlopeToWall slope{9.81, 4.0, 0.5, 700.0};
  const double omega = 2.0;
  const auto groupSpeed = [&](double x_m) {
    return slope.waterAt(x_m).groupSpeed_mps(slope.waterAt(x_m).waveNumber_radpm(omega));
  };
  for (const double x_m : {350.0, 700.0}) {
    const auto response = slope.responseAt(x_m, omega);
    const double k = slope.waterAt(x_m).waveNumber_radpm(omega);
    const double squares = std::norm(response.elevation) + std::norm(response.slope_pm / k);
    EXPECT_NEAR(squares * groupSpeed(x_m) / (4 * groupSpeed(0.0)), 1.0, 0.02) << x_m;
  }
}

TEST(MildSlope, EqualsBesselFunctionsOnALinearSlope) {
  // (d eta')' + omega^2/g eta = 0, d = s y: eta = a J0(u) + b Y0(u), u = 2 omega sqrt(y/(g s)); eta' = 0 at the wall.
  const SlopeToWall slope{9.81, 1.0, 0.25, 300.0};
  const double omega = 0.08;
  const double steepness = 0.75 / 300.0;
  const auto u = [&](double x_m) {
    return 2 * omega * std::sqrt(slope.depthAt_m(x_m) / steepness / (9.81 * steepness));
  };
  const double wall = u(300.0);
  const auto eta = [&](double x_m) {
    return std::cyl_neumann(1.0, wall) * std::cyl_bessel_j(0.0, u(x_m)) -
           std::cyl_bessel_j(1.0, wall) * std::cyl_neumann(0.0, u(x_m));
  };
  const double scale = std::abs(slope.responseAt(300.0, omega).elevation) / std::abs(eta(300.0));
  for (const double x_m : {0.0, 90.0, 210.0})
    EXPECT_NEAR(std::abs(slope.responseAt(x_m, omega).elevation), scale * std::abs(eta(x_m)), 5e-3) << x_m;
}

TEST(WavePacket, TravelsAtItsGroupSpeed) {
  const AiryWater water{9.81, 1.0};
  const WavePacket packet(water, 400.0, 2.0, 12.0);
  EXPECT_NEAR(packet.elevationAt(0.0, 0.0), 1.0, 1e-12);
  EXPECT_NEAR(packet.groupSpeed_mps() / water.groupSpeed_mps(pi), 1.0, 0.01);
  EXPECT_NEAR(packet.flowAt_mps(0.0, 0.0) / water.phaseSpeed_mps(pi), 1.0, 0.01) << "q = c eta";
  double middle = 0.0, weight = 0.0;
  for (int i = 0; i < 2400; ++i) {
    const double x_m = -40 + 0.05 * i;
    middle += x_m * std::pow(packet.elevationAt(x_m, 20.0), 2);
    weight += std::pow(packet.elevationAt(x_m, 20.0), 2);
  }
  EXPECT_NEAR(middle / weight, 20 * packet.groupSpeed_mps(), 0.02 * 20 * packet.groupSpeed_mps());
}

std::pair<sim::WaveLayout, sim::Basin> basinOf(core::Scene& scene, std::uint32_t n, double side_m) {
  scene.wave.emplace();
  scene.wave->resolution_count = n;
  scene.wave->side_m = side_m;
  setBoundaries(*scene.wave, core::WaveBoundary::kReflect);
  const sim::WaveLayout layout = *sim::derive(scene)->wave;
  return {layout, sim::layOutBasin(scene, layout)};
}

TEST(BasinModes, SquareHasTheModesOfTheGrid) {
  core::Scene scene;
  const auto [layout, basin] = basinOf(scene, 32, 4.0);
  const auto modes = lowestModes(layout, basin, 6);
  ASSERT_EQ(modes.size(), 6u);
  const auto k = [](int p) { return 2 / 0.125 * std::sin(pi * p / 64); };
  const double expected[] = {k(1), k(1), std::hypot(k(1), k(1)), k(2), k(2), std::hypot(k(2), k(1))};
  for (std::size_t j = 0; j < 6; ++j) {
    EXPECT_NEAR(modes[j].k_radpm / expected[j], 1.0, 1e-6) << j;
    EXPECT_NEAR(std::inner_product(modes[j].shape.begin(), modes[j].shape.end(), modes[j].shape.begin(), 0.0) / 1024,
                1.0, 1e-9);
  }
}

TEST(BasinModes, LShapedBasinHasTheKnownModes) {
  // The square [-1, 1]^2 without a quadrant, walls all around: k^2 = 1.47562, 3.53403, pi^2, pi^2, 11.38948
  // (M. Dauge's benchmark for Maxwell's equations, 2004).
  core::Scene scene;
  scene.obstacles = {core::Breakwater{.x_m = 0.5, .z_m = 0.5, .length_m = 1.0, .width_m = 1.0}};
  const auto [layout, basin] = basinOf(scene, 64, 2.0);
  const auto modes = lowestModes(layout, basin, 5);
  const double expected[] = {1.47562, 3.53403, pi * pi, pi * pi, 11.38948};
  for (std::size_t j = 0; j < 5; ++j) EXPECT_NEAR(std::pow(modes[j].k_radpm, 2) / expected[j], 1.0, 0.02) << j;
}

TEST(HullHead, PressesWithTheVolumeThatTheHullDisplaces) {
  HullState hull{
      .x_m = 0.3, .z_m = 7.9, .heading_rad = 0.7, .age_s = 5.0, .length_m = 2.4, .beam_m = 0.9, .draught_m = 0.2};
  const auto volume = [&] {
    const std::vector<double> head_m = hullHead(hull, 128, 16.0);
    return std::accumulate(head_m.begin(), head_m.end(), 0.0) / 64;
  };
  EXPECT_NEAR(volume(), 2.4 * 0.9 * 0.2, 0.005 * 2.4 * 0.9 * 0.2);
  hull.age_s = 0.25;
  EXPECT_NEAR(volume(), 0.25 * 2.4 * 0.9 * 0.2, 0.005 * 2.4 * 0.9 * 0.2) << "a new boat presses gradually";
  hull.aloft = 1.0;
  EXPECT_EQ(volume(), 0.0);
}

TEST(ShallowReference, BreaksADamAsStokerSays) {
  const DamBreak exact{9.81, 1.0, 0.1};
  double before_m = 0.0;
  for (const std::size_t cells : {std::size_t{200}, std::size_t{400}}) {
    ShallowReference water(
        20.0, cells, [](double) { return -1.0; },
        [](double x_m) {
          return ShallowReference::Water{x_m < 10 ? 0.0 : -0.9, 0.0};
        });
    water.advance(1.0);
    EXPECT_NEAR(water.time_s(), 1.0, 1e-9);
    double off_m = 0.0;
    for (int k = 0; k < 200; ++k) {
      const double x_m = 0.05 + 0.1 * k;
      off_m += std::abs(water.levelAt(x_m) + 1.0 - exact.at(x_m - 10, 1.0).depth_m) / 200;
    }
    EXPECT_LT(off_m, 0.005);
    if (before_m > 0) {
      EXPECT_LT(off_m, 0.65 * before_m) << "first order at the bore";
    }
    before_m = off_m;
  }
}

TEST(ShallowReference, KeepsLevelWaterBesideLandAndItsVolume) {
  const auto ground = [](double x_m) { return 0.25 * x_m - 1.0; };  // dry beyond 4 m, an edge of cells
  ShallowReference still(5.0, 100, ground, [](double) { return ShallowReference::Water{0.0, 0.0}; });
  const double volume_m2 = still.waterBeyond(0.0);
  EXPECT_NEAR(volume_m2, 2.0, 1e-9);
  still.advance(2.0);
  EXPECT_NEAR(still.levelAt(1.0), 0.0, 1e-9);
  ShallowReference hump(5.0, 100, ground, [](double x_m) { return ShallowReference::Water{x_m < 1 ? 0.2 : 0.0, 0.0}; });
  const double start_m2 = hump.waterBeyond(0.0);
  hump.advance(2.0);
  EXPECT_NEAR(hump.waterBeyond(0.0), start_m2, 1e-3 * start_m2);
  EXPECT_GT(std::abs(hump.levelAt(1.0)), 1e-3) << "moves";
}

}  // namespace
}  // namespace spindrift::study
