// The dispersion's operator in double precision: its symmetry, its walls, and the phase speeds that follow from it.
#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include <spindrift/sim_setup/dispersion.h>

#include "dispersion_reference.h"
#include "dispersion_symbol.h"

namespace spindrift::sim {
namespace {

core::Scene sea(std::uint32_t n, double cell_m, double depth_m, core::WaveBoundary sides) {
  core::Scene scene;
  scene.wave.emplace();
  scene.wave->resolution_count = n;
  scene.wave->side_m = n * cell_m;
  scene.wave->depth_m = depth_m;
  scene.wave->dispersion = core::Dispersion::kAiry;
  setBoundaries(*scene.wave, sides);
  return scene;
}

struct Laid {
  explicit Laid(const core::Scene& scene)
      : wave(*derive(scene)->wave), basin(layOutBasin(scene, wave)), operator_f(layOutDispersion(wave, basin)) {}

  /// -div F grad(level), in cells.
  [[nodiscard]] std::vector<double> pull(const std::vector<double>& level) const {
    const auto faces = operator_f.apply(level);
    std::vector<double> out(level.size());
    const int nx = static_cast<int>(wave.count_x);
    const int nz = static_cast<int>(wave.count_z);
    const auto index = [&](int x, int z) { return static_cast<std::size_t>((x + nx) % nx + nx * ((z + nz) % nz)); };
    for (int z = 0; z < nz; ++z) {
      for (int x = 0; x < nx; ++x) {
        out[index(x, z)] =
            faces[index(x - 1, z)][0] - faces[index(x, z)][0] + faces[index(x, z - 1)][1] - faces[index(x, z)][1];
      }
    }
    return out;
  }

  WaveLayout wave;
  Basin basin;
  DispersionReference operator_f;
};

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

std::vector<double> noise(std::size_t count, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> level(-1.0, 1.0);
  std::vector<double> out(count);
  for (double& v : out) v = level(random);
  return out;
}

core::Scene harborLike() {
  core::Scene scene = sea(96, 0.125, 1.2, core::WaveBoundary::kReflect);
  scene.obstacles.emplace_back(core::Rock{.x_m = 2.1, .z_m = -1.3, .radius_m = 0.9});
  scene.obstacles.emplace_back(
      core::Breakwater{.x_m = -1.0, .z_m = 2.0, .length_m = 5.0, .width_m = 0.2, .heading_deg = 30});
  scene.beaches.push_back({.side = core::Side::kPlusX, .width_m = 4.0, .shore_depth_m = 0.0});
  return scene;
}

/// Phase speed of a plane wave with (mx, mz) periods in the domain over that of the closed form.
double speedRatio(const Laid& laid, int mx, int mz, double gravity_mps2) {
  const DispersionLevel& grid = laid.operator_f.dispersion().levels.front();
  const int n = static_cast<int>(grid.count.x);
  std::vector<double> level(grid.stiffness.size());
  for (int z = 0; z < n; ++z) {
    for (int x = 0; x < n; ++x) level[grid.index(x, z)] = std::cos(2 * std::numbers::pi * (mx * x + mz * z) / n + 0.3);
  }
  const double cell_m = laid.wave.cell_m;
  const double square = gravity_mps2 * dot(level, laid.pull(level)) / dot(level, level) / (cell_m * cell_m);
  const double depth_m = laid.basin.depth_m.front();
  const double k_pm = 2 * std::numbers::pi * std::hypot(mx, mz) / (n * cell_m);
  const double dt_s = laid.wave.dt_s;
  const double omega = 2 / dt_s * std::asin(0.5 * dt_s * std::sqrt(square));
  return omega / std::sqrt(gravity_mps2 * k_pm * std::tanh(k_pm * depth_m));
}

core::Scene channel(std::uint32_t along, std::uint32_t across) {
  core::Scene scene = sea(along, 0.125, 1.2, core::WaveBoundary::kReflect);
  scene.wave->width_m = 0.125 * across;
  return scene;
}

TEST(Dispersion, WavesAlongAChannelAreEquallyFastInAllOfItsWidth) {
  for (const std::uint32_t across : {1u, 2u, 5u, 10u, 13u, 37u}) {
    const Laid laid(channel(150, across));
    std::vector<double> level(laid.basin.depth_m.size());
    for (std::size_t i = 0; i < level.size(); ++i)
      level[i] = std::cos(std::numbers::pi * 7 * (static_cast<double>(i % 150) + 0.5) / 150);
    const std::vector<double> pull = laid.pull(level);
    double worst = 0.0;
    for (std::size_t i = 0; i < pull.size(); ++i) worst = std::max(worst, std::abs(pull[i] - pull[i % 150]));
    EXPECT_LT(worst, 1e-5) << across;  // tables of 16 bits
  }
}

TEST(Dispersion, WavesAlongAChannelAreAsFastAsInASquare) {
  // omega^2 of a wave with m periods along x, up to a factor.
  const auto squareOf = [](const Laid& laid, int m) {
    std::vector<double> level(laid.basin.depth_m.size());
    for (std::size_t i = 0; i < level.size(); ++i)
      level[i] =
          std::cos(2 * std::numbers::pi * m * static_cast<double>(i % laid.wave.count_x) / laid.wave.count_x + 0.3);
    return dot(level, laid.pull(level)) / dot(level, level);
  };
  const Laid square(sea(256, 0.125, 1.2, core::WaveBoundary::kPeriodic));
  std::map<int, double> wanted;
  for (const int m : {1, 4, 16, 32, 64}) wanted[m] = squareOf(square, m);
  for (const std::uint32_t across : {1u, 10u, 13u, 37u, 100u}) {
    core::Scene scene = channel(256, across);
    scene.wave->boundary_minus_x = scene.wave->boundary_plus_x = core::WaveBoundary::kPeriodic;
    const Laid laid(scene);
    for (const auto& [m, square_m] : wanted)
      EXPECT_NEAR(std::sqrt(squareOf(laid, m) / square_m), 1.0, 5e-4) << across << " wide, " << m << " periods";
  }
}

TEST(Dispersion, WavesAlongAChannelOverAnUnevenBedAreAsFastAsOverALevelOne) {
  for (const std::uint32_t across : {1u, 4u, 5u, 8u, 10u, 13u, 32u, 37u}) {
    const Laid level_bed(channel(256, across));
    // The same depths, laid out as over an uneven bed.
    Basin uneven = level_bed.basin;
    uneven.is_flat = false;
    const DispersionReference operator_f(layOutDispersion(level_bed.wave, uneven));
    for (const int m : {1, 4, 16, 32, 64}) {
      std::vector<double> level(level_bed.basin.depth_m.size());
      for (std::size_t i = 0; i < level.size(); ++i)
        level[i] = std::cos(std::numbers::pi * m * (static_cast<double>(i % 256) + 0.5) / 256);
      const auto faces = operator_f.apply(level);
      const auto expected = level_bed.operator_f.apply(level);
      double worst = 0.0, largest = 0.0;
      for (std::size_t i = 0; i < faces.size(); ++i) {
        worst = std::max({worst, std::abs(faces[i][0] - expected[i][0]), std::abs(faces[i][1] - expected[i][1])});
        largest = std::max(largest, std::abs(expected[i][0]));
      }
      EXPECT_LT(worst / largest, 1e-3) << across << " wide, " << m << " half periods";  // tables of 16 bits
    }
  }
}

TEST(Dispersion, IsSymmetricAndPositiveOverAnyBed) {
  const Laid laid(harborLike());
  for (std::uint32_t seed = 1; seed < 4; ++seed) {
    const auto a = noise(laid.basin.depth_m.size(), seed);
    const auto b = noise(laid.basin.depth_m.size(), seed + 100);
    EXPECT_NEAR(dot(a, laid.pull(b)) / dot(b, laid.pull(a)), 1.0, 1e-12);
    EXPECT_GT(dot(a, laid.pull(a)), 0.0);
  }
}

TEST(Dispersion, IsSymmetricAndPositiveBesideThinWalls) {
  core::Scene scene = sea(96, 0.1, 4.0, core::WaveBoundary::kReflect);
  for (const int column : {23, 37, 50, 71}) {
    scene.obstacles.emplace_back(core::Breakwater{.x_m = (column + 0.5) * 0.1 - 4.8,
                                                  .z_m = 0.02 * column - 1.0,
                                                  .length_m = 5.0,
                                                  .width_m = 0.09,
                                                  .heading_deg = column == 37 ? 80.0 : 90.0});
  }
  const Laid laid(scene);
  for (std::uint32_t seed = 1; seed < 4; ++seed) {
    const auto a = noise(laid.basin.depth_m.size(), seed);
    const auto b = noise(laid.basin.depth_m.size(), seed + 100);
    EXPECT_NEAR(dot(a, laid.pull(b)) / dot(b, laid.pull(a)), 1.0, 1e-11);
    EXPECT_GT(dot(a, laid.pull(a)), 0.0);
  }
}

TEST(Dispersion, LeavesLevelWaterBesideAWallAlone) {
  core::Scene scene = sea(64, 0.125, 1.2, core::WaveBoundary::kReflect);
  scene.obstacles.emplace_back(core::Breakwater{.x_m = 0.3, .length_m = 100, .width_m = 0.125, .heading_deg = 90});
  const Laid laid(scene);
  std::vector<double> level(laid.basin.depth_m.size());
  const DispersionLevel& grid = laid.operator_f.dispersion().levels.front();
  for (int z = 0; z < 64; ++z) {
    for (int x = 0; x < 64; ++x) level[grid.index(x, z)] = x < 34 ? 0.05 : -0.02;
  }
  for (const double pull : laid.pull(level)) EXPECT_EQ(pull, 0.0);
  // A wave on one side moves nothing on the other.
  level.assign(level.size(), 0.0);
  level[grid.index(30, 30)] = 1.0;
  const auto pull = laid.pull(level);
  for (int z = 0; z < 64; ++z) {
    for (int x = 36; x < 64; ++x) EXPECT_EQ(pull[grid.index(x, z)], 0.0);
  }
}

TEST(Dispersion, HasThePhaseSpeedsOfAiryWaves) {
  for (const double depth_cells : {3.0, 7.2, 16.0}) {
    const core::Scene scene = sea(128, 0.125, depth_cells * 0.125, core::WaveBoundary::kPeriodic);
    const Laid laid(scene);
    double off_8 = 0.0;
    double off_4 = 0.0;
    for (int m = 1; m <= 32; ++m) {
      for (const auto& [mx, mz] : {std::pair{m, 0}, std::pair{m, m}, std::pair{m, m / 2}}) {
        const double cells = 128 / std::hypot(mx, mz);
        const double kd = 2 * std::numbers::pi / cells * depth_cells;
        if (cells < 4.0 || kd > 10.0) continue;
        const double off = std::abs(speedRatio(laid, mx, mz, scene.gravity_mps2) - 1);
        (cells >= 8.0 ? off_8 : off_4) = std::max(cells >= 8.0 ? off_8 : off_4, off);
      }
    }
    EXPECT_LE(off_8, 0.01) << depth_cells;
    EXPECT_LE(off_4, 0.025) << depth_cells;
  }
}

/// Depths of the fitted table and between them, and beyond its ends.
std::vector<double> depthsCells() {
  std::vector<double> out;
  for (double depth_cells = 0.4; depth_cells < 80.0; depth_cells *= 1.13) out.push_back(depth_cells);
  return out;
}

/// As many grids as 256 cells per side have.
constexpr std::size_t kGridCount = 7;

TEST(Dispersion, HasTheSymbolOfTheReference) {
  for (const double depth_cells : {1.3, 7.2, 40.0}) {
    constexpr int kSide = 64;
    const Laid laid(sea(kSide, 0.125, depth_cells * 0.125, core::WaveBoundary::kPeriodic));
    const DispersionSymbol symbol(depth_cells, polesAt(depth_cells), laid.operator_f.dispersion().levels.size());
    const DispersionLevel& grid = laid.operator_f.dispersion().levels.front();
    for (const auto& [mx, mz] :
         {std::pair{1, 0}, std::pair{4, 0}, std::pair{3, 7}, std::pair{8, 8}, std::pair{31, 20}}) {
      // Both phases: the cycle is not the same at every cell.
      double product = 0.0;
      double square = 0.0;
      for (const double phase : {0.3, 0.3 + std::numbers::pi / 2}) {
        std::vector<double> level(grid.stiffness.size());
        for (int z = 0; z < kSide; ++z) {
          for (int x = 0; x < kSide; ++x)
            level[grid.index(x, z)] = std::cos(2 * std::numbers::pi * (mx * x + mz * z) / kSide + phase);
        }
        product += dot(level, laid.pull(level));
        square += dot(level, level);
      }
      const double kx = 2 * std::numbers::pi * mx / kSide;
      const double kz = 2 * std::numbers::pi * mz / kSide;
      const double wanted = symbol.share(kx, kz) * laid.basin.depth_m.front() * DispersionSymbol::laplacian(kx, kz);
      EXPECT_NEAR(product / square / wanted, 1.0, 1e-6) << depth_cells << ", " << mx << ", " << mz;
    }
  }
}

TEST(Dispersion, HasAirysGroupSpeedsInEveryDirection) {
  for (const double depth_cells : depthsCells()) {
    if (depth_cells < 0.9 || depth_cells > 45.0) continue;
    const DispersionSymbol symbol(depth_cells, polesAt(depth_cells), kGridCount);
    const auto frequency = [&](double k, double direction_rad) {
      const double kx = k * std::cos(direction_rad);
      const double kz = k * std::sin(direction_rad);
      return std::sqrt(depth_cells * DispersionSymbol::laplacian(kx, kz) * symbol.share(kx, kz));
    };
    const auto airy = [&](double k) { return std::sqrt(k * std::tanh(k * depth_cells)); };
    constexpr double kStep = 0.03;
    double along = 0.0;
    double across = 0.0;
    for (double cells = 8.3; cells < 128.0; cells *= 1.1) {
      const double k = 2 * std::numbers::pi / cells;
      if (k * depth_cells > 10.0 || k * depth_cells < 0.2) continue;
      const double group = (airy(k * (1 + kStep)) - airy(k)) / (kStep * k);
      for (double direction_rad = 0.0; direction_rad < 0.8; direction_rad += 0.15) {
        const double here = frequency(k, direction_rad);
        along = std::max(along, std::abs((frequency(k * (1 + kStep), direction_rad) - here) / (kStep * k * group) - 1));
        across = std::max(across, std::abs((frequency(k, direction_rad + kStep) - here) / (kStep * k * group)));
      }
    }
    EXPECT_LE(along, 0.04) << depth_cells;
    EXPECT_LE(across, 0.035) << depth_cells;
  }
}

TEST(Dispersion, KeepsWavesOfABlockNearAirysFrequency) {
  for (const double depth_cells : depthsCells()) {
    if (depth_cells < 1.5 || depth_cells > 45.0) continue;
    const DispersionSymbol symbol(depth_cells, polesAt(depth_cells), kGridCount);
    for (std::size_t grid = 1; grid < 5; ++grid) {  // waves of 4, 8, 16, 32 cells along an axis
      const double k = 2 * std::numbers::pi / std::pow(2.0, static_cast<double>(grid + 1));
      if (k * depth_cells > 10.0) continue;
      const double mean = std::sqrt(depth_cells * DispersionSymbol::laplacian(k, 0) * symbol.share(k, 0) /
                                    (k * std::tanh(k * depth_cells)));
      for (const double sign : {-0.5, 0.5})
        EXPECT_NEAR(mean * (1 + sign * symbol.split(grid)), 1.0, grid == 1 ? 0.03 : 0.01)
            << depth_cells << ", " << grid;
    }
  }
}

TEST(Dispersion, IsPositiveAndStableForEveryWave) {
  constexpr double kCell_m = 0.125;
  constexpr double kGravity_mps2 = 9.81;
  for (const double depth_cells : depthsCells()) {
    const DispersionSymbol symbol(depth_cells, polesAt(depth_cells), kGridCount);
    const double step_s = dispersedMaxStep(kGravity_mps2, depth_cells * kCell_m, kCell_m);
    constexpr int kSamples = 48;
    for (int x = 1; x <= kSamples; ++x) {
      for (int z = 0; z <= x; ++z) {
        const double kx = std::numbers::pi * x / kSamples;
        const double kz = std::numbers::pi * z / kSamples;
        const double share = symbol.share(kx, kz);
        ASSERT_GT(share, 0.0) << depth_cells << ", " << kx << ", " << kz;
        const double omega_radps =
            std::sqrt(kGravity_mps2 * depth_cells * share * DispersionSymbol::laplacian(kx, kz) / kCell_m);
        // The leapfrog is stable up to 2; a tenth is left for uneven beds.
        ASSERT_LE(omega_radps * step_s, 1.8) << depth_cells << ", " << kx << ", " << kz;
      }
    }
  }
}

}  // namespace
}  // namespace spindrift::sim
