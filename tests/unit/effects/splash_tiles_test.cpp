#include <cmath>
#include <random>
#include <set>

#include <gtest/gtest.h>
#include <shared/groups.h>

#include <spindrift/effects/splash_tiles.h>

namespace spindrift::sim {
namespace {

constexpr double kCell_m = 0.1;

WaveLayout waveOf(std::uint32_t count_x, std::uint32_t count_z, bool is_periodic_x, bool is_periodic_z) {
  return {.count_x = count_x,
          .count_z = count_z,
          .length_m = kCell_m * count_x,
          .width_m = kCell_m * count_z,
          .cell_m = kCell_m,
          .is_periodic_x = is_periodic_x,
          .is_periodic_z = is_periodic_z};
}

double across(double d_m, double side_m, bool is_periodic) {
  return is_periodic ? d_m - side_m * std::round(d_m / side_m) : d_m;
}

/// Compares with every face of every cell; a number of cells that tiles do not divide.
TEST(SplashTiles, EachSplashIsInTheTilesOfAllFacesThatItReaches) {
  std::mt19937 random(7);
  const auto between = [&](double low, double high) {
    return low + (high - low) * std::generate_canonical<double, 53>(random);
  };
  for (const auto& periodic : {std::pair{false, false}, {true, false}, {true, true}}) {
    const bool px = periodic.first, pz = periodic.second;
    const WaveLayout wave = waveOf(61, 44, px, pz);
    SplashTiles tiles(wave);
    for (int round = 0; round < 20; ++round) {
      shared::EventUniforms events{};
      events.splash_count = round == 0 ? 0 : round == 1 ? MAX_PRESSES : 40;
      for (std::uint32_t k = 0; k < events.splash_count; ++k) {
        events.splashes[k].x_m = static_cast<float>(between(-3.5, 3.5));
        events.splashes[k].z_m = static_cast<float>(between(-2.5, 2.5));
        events.splashes[k].radius_m = static_cast<float>(k % 10 == 0 ? between(0.5, 3.0) : between(0.02, 0.3));
      }
      std::set<std::pair<std::uint32_t, std::uint32_t>> found;  // tile and splash
      std::set<std::uint32_t> seen;
      const auto list = tiles.list(events);
      ASSERT_LE(list.size(), tiles.count());
      for (const shared::SplashTile& tile : list) {
        const std::uint32_t at = tile.place & 0xffffffu;
        EXPECT_TRUE(seen.insert(at).second) << "listed twice";
        for (std::uint32_t k = 0; k < MAX_PRESSES; ++k)
          if (tile.place >> (24 + k / 32) & tile.splashes[k / 32] >> k % 32 & 1u) found.insert({at, k});
      }
      for (std::uint32_t k = 0; k < events.splash_count; ++k) {
        const auto& splash = events.splashes[k];
        for (std::uint32_t z = 0; z < wave.count_z; ++z) {
          for (std::uint32_t x = 0; x < wave.count_x; ++x) {
            const double dx_m = (x + 0.5) * kCell_m - wave.length_m / 2 - splash.x_m;
            const double dz_m = (z + 0.5) * kCell_m - wave.width_m / 2 - splash.z_m;
            const auto distance_m = [&](double more_x_m, double more_z_m) {
              return std::hypot(across(dx_m + more_x_m, wave.length_m, px), across(dz_m + more_z_m, wave.width_m, pz));
            };
            if (std::min(distance_m(kCell_m / 2, 0), distance_m(0, kCell_m / 2)) >= SPLASH_REACH * splash.radius_m)
              continue;
            const std::uint32_t tile = x / SPLASH_TILE | z / SPLASH_TILE << 12;
            ASSERT_TRUE(found.contains({tile, k})) << "cell " << x << ", " << z << ", splash " << k;
          }
        }
      }
    }
  }
}

TEST(SplashTiles, ASmallSplashIsInFewTiles) {
  SplashTiles tiles(waveOf(512, 512, false, false));
  shared::EventUniforms events{};
  events.splash_count = 1;
  events.splashes[0].radius_m = 0.25f;  // reaches 9 cells
  EXPECT_LE(tiles.list(events).size(), 16u);
  events.splash_count = 0;
  EXPECT_TRUE(tiles.list(events).empty());
}

}  // namespace
}  // namespace spindrift::sim
