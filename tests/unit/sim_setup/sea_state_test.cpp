#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include <spindrift/sim_setup/sea_state.h>

namespace spindrift::sim {
namespace {

using std::numbers::pi;

core::Scene openSea() {
  core::Scene scene;
  scene.wave.emplace();
  scene.wave->resolution_count = 256;
  scene.wave->side_m = 30.0;
  scene.wave->depth_m = 2.0;
  scene.wave->dispersion = core::Dispersion::kAiry;
  setBoundaries(*scene.wave, core::WaveBoundary::kAbsorb);
  scene.storm.emplace();
  scene.storm->level_ratio = 1.0;
  scene.storm->wave_height_m = 1.0;
  scene.storm->wind_direction_deg = 30.0;
  return scene;
}

SeaState seaOf(const core::Scene& scene) {
  return seaState(scene, *derive(scene)->wave);
}

// The page continues the sea outside the water with the same waves. web-client/test/sea.test.ts compares its own with
// the same file. SPINDRIFT_UPDATE_GOLDEN=1 writes it again.
TEST(SeaState, IsTheOneThatThePageDrawsOutside) {
  const auto file = std::filesystem::path(SPINDRIFT_SOURCE_DIR) / "tests" / "golden" / "sea_waves.txt";
  core::Scene scene = openSea();
  scene.seed = 7;
  const SeaState sea = seaOf(scene);
  const char* update = std::getenv("SPINDRIFT_UPDATE_GOLDEN");
  if (update != nullptr && std::string(update) == "1") {
    std::ofstream out(file);
    out.precision(17);
    for (const PlaneWave& wave : sea.waves)
      out << wave.amplitude_m << ' ' << wave.omega_radps << ' ' << wave.kx_radpm << ' ' << wave.kz_radpm << ' '
          << wave.phase_rad << '\n';
    GTEST_SKIP() << "wrote " << file;
  }
  std::ifstream in(file);
  std::size_t count = 0;
  PlaneWave kept;
  for (; in >> kept.amplitude_m >> kept.omega_radps >> kept.kx_radpm >> kept.kz_radpm >> kept.phase_rad; ++count) {
    ASSERT_LT(count, sea.waves.size());
    const PlaneWave& wave = sea.waves[count];
    EXPECT_NEAR(wave.amplitude_m, kept.amplitude_m, 1e-9);
    EXPECT_NEAR(wave.omega_radps, kept.omega_radps, 1e-9);
    EXPECT_NEAR(wave.kx_radpm, kept.kx_radpm, 1e-9);
    EXPECT_NEAR(wave.kz_radpm, kept.kz_radpm, 1e-9);
    EXPECT_NEAR(wave.phase_rad, kept.phase_rad, 1e-9);
  }
  EXPECT_EQ(count, sea.waves.size()) << file;
}

TEST(WaveNumber, SolvesAirysRelationFromShallowToDeepWater) {
  for (const double kd : {1e-3, 0.03, 0.5, 1.0, 2.0, 7.0, 40.0, 900.0}) {
    for (const double depth_m : {0.05, 2.0, 100.0}) {
      const double k = kd / depth_m;
      EXPECT_NEAR(waveNumber(waveFrequency(k, 9.81, depth_m), 9.81, depth_m), k, 1e-9 * k) << kd << ", " << depth_m;
    }
  }
}

/// Integral of omega^power times the density.
double moment(const WindSeaSpectrum& spectrum, int power) {
  double sum = 0.0;
  const double step = 0.001 * spectrum.peak_radps;
  for (double omega = 0.3 * spectrum.peak_radps; omega < 30 * spectrum.peak_radps; omega += step)
    sum += std::pow(omega, power) * spectrum.density(omega) * step;
  return sum;
}

TEST(WindSeaSpectrum, EqualsJonswapInDeepWater) {
  const double wind_mps = 15.0;
  const double fetch_m = 2000.0;
  const auto spectrum = WindSeaSpectrum::of(wind_mps, fetch_m, 9.81, 1000.0);
  EXPECT_NEAR(spectrum.peak_radps, 22 * std::cbrt(9.81 * 9.81 / (wind_mps * fetch_m)), 1e-9);
  // Hasselmann et al. 1973: g sqrt(m0)/U^2 = 4e-4 sqrt(g F/U^2), fitted to the same measurements by itself.
  EXPECT_NEAR(4 * std::sqrt(moment(spectrum, 0)), 1.6e-3 * wind_mps * std::sqrt(fetch_m / 9.81), 0.01);
  // The shape with a peak enhancement of 3.3, integrated by itself: m0 = 0.3050 alpha g^2/omega_p^4, and a mean period
  // of 0.834 of the peak's.
  EXPECT_NEAR(moment(spectrum, 0), 0.3050 * spectrum.alpha * std::pow(9.81, 2) / std::pow(spectrum.peak_radps, 4),
              0.01 * moment(spectrum, 0));
  EXPECT_NEAR(moment(spectrum, 0) / moment(spectrum, 1) * spectrum.peak_radps, 0.834, 0.01);
  double highest = 0.0;
  double at = 0.0;
  for (double omega = 0.5 * spectrum.peak_radps; omega < 2 * spectrum.peak_radps; omega += 1e-4) {
    if (spectrum.density(omega) > highest) {
      highest = spectrum.density(omega);
      at = omega;
    }
  }
  EXPECT_NEAR(at, spectrum.peak_radps, 0.01 * spectrum.peak_radps);
}

TEST(WindSeaSpectrum, IsLowerInShallowWater) {
  const auto deep = WindSeaSpectrum::of(15.0, 2000.0, 9.81, 1000.0);
  const auto shallow = WindSeaSpectrum::of(15.0, 2000.0, 9.81, 0.5);
  // Kitaigorodskii's factor tends to (omega sqrt(d/g))^2/2 (Bouws et al. 1985).
  const double omega = 0.8;
  EXPECT_NEAR(shallow.density(omega) / WindSeaSpectrum::of(15.0, 2000.0, 9.81, 1000.0).density(omega),
              omega * omega * 0.5 / 9.81 / 2, 0.001);
  EXPECT_LT(moment(shallow, 0), 0.5 * moment(deep, 0));
}

TEST(WindSeaSpectrum, StopsGrowingWithTheFetchWhenFullyDeveloped) {
  const auto far = WindSeaSpectrum::of(5.0, 1e6, 9.81, 100.0);
  EXPECT_NEAR(far.peak_radps, 0.88 * 9.81 / 5.0, 0.01);
  EXPECT_NEAR(far.alpha, 0.0081, 0.001);
}

TEST(SeaState, HoldsTheEnergyOfTheSpectrumThatTheGridResolves) {
  const SeaState sea = seaOf(openSea());
  ASSERT_EQ(sea.waves.size(), static_cast<std::size_t>(kSeaWaveCount));
  double variance_m2 = 0.0;
  for (const PlaneWave& wave : sea.waves) {
    variance_m2 += 0.5 * wave.amplitude_m * wave.amplitude_m;
    const double length_m = 2 * pi / std::hypot(wave.kx_radpm, wave.kz_radpm);
    EXPECT_GE(length_m, kShortestWave_cells * 30.0 / 256 - 1e-9);
    EXPECT_LE(length_m, 15.0 + 1e-9);
  }
  EXPECT_NEAR(4 * std::sqrt(variance_m2), sea.significant_height_m, 1e-9);
  const double whole_m = 4 * std::sqrt(moment(WindSeaSpectrum::of(15.0, 2000.0, 9.81, 2.0), 0));
  EXPECT_LT(sea.significant_height_m, whole_m);
  EXPECT_GT(sea.significant_height_m, 0.95 * whole_m) << "of the waves of this wind few are too short for the grid";
}

TEST(SeaState, TravelsWithTheWind) {
  core::Scene scene = openSea();
  for (const double direction_deg : {-170.0, -45.0, 0.0, 30.0, 90.0}) {
    scene.storm->wind_direction_deg = direction_deg;
    std::complex<double> mean;
    for (const PlaneWave& wave : seaOf(scene).waves) {
      const std::complex<double> k{wave.kx_radpm, wave.kz_radpm};
      mean += k / std::abs(k);
      EXPECT_GT(std::cos(std::arg(k) - direction_deg * pi / 180), 0.0);
    }
    EXPECT_NEAR(std::arg(mean * std::polar(1.0, -direction_deg * pi / 180)), 0.0, 0.03) << direction_deg;
    EXPECT_LT(std::abs(mean), 0.97 * kSeaWaveCount) << "directions are spread";
  }
}

TEST(SeaState, HeightIsLimitedBySceneAndDepth) {
  core::Scene scene = openSea();
  scene.storm->wave_height_m = 0.2;
  EXPECT_NEAR(seaOf(scene).significant_height_m, 0.2, 1e-9);
  scene.storm->level_ratio = 0.5;
  EXPECT_NEAR(seaOf(scene).significant_height_m, 0.1, 1e-9);
  scene.storm->level_ratio = 1.0;
  scene.storm->wave_height_m = 10.0;
  scene.storm->wind_speed_mps = 60.0;
  scene.wave->depth_m = 0.3;
  EXPECT_LE(seaOf(scene).significant_height_m, 0.15 + 1e-9);
}

TEST(SeaState, EntersOnlyAtOpenSides) {
  core::Scene scene = openSea();
  constexpr std::uint32_t kAll = MINUS_X_BIT | PLUS_X_BIT | MINUS_Z_BIT | PLUS_Z_BIT;
  for (const PlaneWave& wave : seaOf(scene).waves) EXPECT_EQ(wave.sides, kAll) << "nothing is in the way";
  scene.wave->boundary_plus_x = core::WaveBoundary::kReflect;
  scene.wave->boundary_plus_z = core::WaveBoundary::kReflect;
  scene.storm->wind_direction_deg = 170.0;  // away from the wall at +x, a little toward +z
  bool comes_from_land = false;
  for (const PlaneWave& wave : seaOf(scene).waves) {
    if (wave.kz_radpm < 0) {
      EXPECT_EQ(wave.sides, 0u);
      comes_from_land = true;
    } else {
      EXPECT_EQ(wave.sides, MINUS_Z_BIT) << "the other part of its front is behind the wall";
    }
  }
  EXPECT_TRUE(comes_from_land);
}

TEST(SeaState, FitsAWholeNumberOfWavesBetweenPeriodicSides) {
  core::Scene scene = openSea();
  scene.wave->boundary_minus_z = scene.wave->boundary_plus_z = core::WaveBoundary::kPeriodic;
  for (const PlaneWave& wave : seaOf(scene).waves) {
    const double count = wave.kz_radpm * 30.0 / (2 * pi);
    EXPECT_NEAR(count, std::round(count), 1e-9);
    EXPECT_EQ(wave.sides, MINUS_X_BIT | PLUS_X_BIT);
    EXPECT_NEAR(wave.omega_radps, waveFrequency(std::hypot(wave.kx_radpm, wave.kz_radpm), 9.81, 2.0), 1e-9);
  }
}

TEST(SeaState, IsCalmWithoutWindOrWithGusts) {
  core::Scene scene = openSea();
  scene.storm->level_ratio = 0.0;
  EXPECT_TRUE(seaOf(scene).waves.empty());
  scene = openSea();
  scene.storm->wind_speed_mps = 0.0;
  EXPECT_TRUE(seaOf(scene).waves.empty());
  scene = openSea();
  scene.wave->dispersion = core::Dispersion::kNone;
  EXPECT_TRUE(seaOf(scene).waves.empty());
  scene = openSea();
  setBoundaries(*scene.wave, core::WaveBoundary::kReflect);
  EXPECT_TRUE(seaOf(scene).waves.empty());
  scene = openSea();
  scene.gravity_mps2 = 0.0;
  EXPECT_TRUE(seaOf(scene).waves.empty());
}

TEST(SeaState, RepeatsAndDependsOnTheSeed) {
  core::Scene scene = openSea();
  const SeaState first = seaOf(scene);
  EXPECT_EQ(seaOf(scene), first);
  scene.seed = 2;
  EXPECT_NE(seaOf(scene), first);
}

TEST(SeaState, IsFiniteForEveryValueInRange) {
  for (const double wind_mps : {0.1, 15.0, 60.0}) {
    for (const double fetch_m : {10.0, 1e6}) {
      for (const double depth_m : {0.05, 2.0, 100.0}) {
        for (const double side_m : {1.0, 1000.0}) {
          for (const double damping_per_s : {0.0, 5.0}) {
            core::Scene scene = openSea();
            scene.wave->resolution_count = 32;
            scene.wave->side_m = side_m;
            scene.wave->depth_m = depth_m;
            scene.wave->sponge_width_m = side_m / 4;
            scene.wave->damping_per_s = damping_per_s;
            scene.storm->wind_speed_mps = wind_mps;
            scene.storm->fetch_m = fetch_m;
            WaveLayout layout;
            layout.count_x = layout.count_z = 32;
            layout.length_m = layout.width_m = side_m;
            layout.cell_m = side_m / 32;
            const SeaState sea = seaState(scene, layout);
            EXPECT_LE(sea.significant_height_m, 0.5 * depth_m + 1e-12);
            for (const PlaneWave& wave : sea.waves) {
              for (const double value :
                   {wave.amplitude_m, wave.omega_radps, wave.kx_radpm, wave.kz_radpm, wave.phase_rad, wave.decay_pm})
                EXPECT_TRUE(std::isfinite(value));
              EXPECT_GT(wave.omega_radps, 0.0);
            }
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace spindrift::sim
