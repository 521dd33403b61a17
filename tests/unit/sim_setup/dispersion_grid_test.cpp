// The coarse grids of the dispersion beside walls: which cells they stand for, where their fluxes go, and what passes
// the end of a wall.
#include "dispersion_grid.h"

#include <functional>

#include <gtest/gtest.h>

namespace spindrift::sim {
namespace {

constexpr int kGridSide = 32;

/// Water of depth 1 between four walls, dry where `is_dry` says so.
DispersionGrid basinWith(const std::function<bool(int x, int z)>& is_dry) {
  DispersionGrid grid({kGridSide, kGridSide}, {kGridSide, kGridSide});
  for (int z = 0; z < kGridSide; ++z) {
    for (int x = 0; x < kGridSide; ++x) {
      if (is_dry(x, z)) continue;
      const std::size_t i = grid.at(x, z);
      grid.wet[i] = 1.0;
      for (std::size_t axis = 0; axis < 2; ++axis) {
        const int next_x = axis == 0 ? x + 1 : x;
        const int next_z = axis == 0 ? z : z + 1;
        if (next_x == kGridSide || next_z == kGridSide || is_dry(next_x, next_z)) continue;
        grid.open[i][axis] = grid.resistance_pm[i][axis] = 1.0;
      }
    }
  }
  return grid;
}

/// All grids down to 4 x 4 cells.
struct Grids {
  explicit Grids(DispersionGrid finest) : grids{std::move(finest)} {
    while (grids.back().nx > 4) {
      const auto half = static_cast<std::uint32_t>(grids.back().nx / 2);
      coarsened.push_back(coarsen(grids.back(), {half, half}));
      owners.push_back(coarsened.back().owner);
      grids.push_back(coarsened.back().grid);
    }
  }
  std::vector<DispersionGrid> grids;
  std::vector<Coarsened> coarsened;
  std::vector<CellOwners> owners;
};

DispersionGrid withWallAt(int column) {
  return basinWith([=](int x, int z) { return x == column && z >= 8; });
}

TEST(DispersionGrid, StandsForEveryWetCellBesideAStraightWall) {
  for (int column = 8; column < 16; ++column) {
    const Grids along_z(withWallAt(column));
    const Grids along_x(basinWith([=](int x, int z) { return z == column && x < 20; }));
    for (const Grids* each : {&along_z, &along_x}) {
      for (std::size_t k = 0; k < each->owners.size(); ++k) {
        for (std::size_t i = 0; i < each->owners[k].size(); ++i)
          EXPECT_EQ(each->owners[k][i].has_value(), each->grids[k].wet[i] > 0.0)
              << column << ", grid " << k << ", cell " << i;
      }
    }
  }
}

TEST(DispersionGrid, SpreadsACoarseFluxEvenly) {
  for (const int column : {8, 9, 10, 11, 13}) {
    const Grids all(withWallAt(column));
    for (std::size_t k = 0; k < all.coarsened.size(); ++k) {
      const DispersionGrid& fine = all.grids[k];
      const DispersionGrid& coarse = all.grids[k + 1];
      // One flux through every open coarse face, all different.
      std::vector<std::array<double, 2>> flux(coarse.wet.size());
      for (std::size_t i = 0; i < flux.size(); ++i) {
        for (std::size_t axis = 0; axis < 2; ++axis)
          flux[i][axis] = coarse.open[i][axis] > 0.0 ? 1.0 + static_cast<double>((7 * i + 3 * axis) % 11) : 0.0;
      }
      std::vector<double> gained(fine.wet.size(), 0.0);
      std::vector<double> coarse_gained(coarse.wet.size(), 0.0);
      for (int z = 0; z < fine.nz; ++z) {
        for (int x = 0; x < fine.nx; ++x) {
          const std::size_t i = fine.at(x, z);
          const int bx = x / 2;
          const int bz = z / 2;
          const double around[4] = {flux[coarse.at(bx, bz)][0], flux[coarse.at(bx - 1, bz)][0],
                                    flux[coarse.at(bx, bz)][1], flux[coarse.at(bx, bz - 1)][1]};
          for (int axis = 0; axis < 2; ++axis) {
            const auto& weights = axis == 0 ? all.coarsened[k].from_coarse_x[i] : all.coarsened[k].from_coarse_z[i];
            double through = 0.0;
            for (std::size_t side = 0; side < 4; ++side) through += weights[side] * around[side];
            if (fine.open[i][static_cast<std::size_t>(axis)] <= 0.0) {
              EXPECT_EQ(through, 0.0) << "a closed face";
            }
            gained[i] -= through;
            gained[fine.behind(i, axis)] += through;
          }
        }
      }
      for (std::size_t i = 0; i < flux.size(); ++i) {
        for (int axis = 0; axis < 2; ++axis) {
          coarse_gained[i] -= 2 * flux[i][static_cast<std::size_t>(axis)];  // a coarse face is two faces wide
          coarse_gained[coarse.behind(i, axis)] += 2 * flux[i][static_cast<std::size_t>(axis)];
        }
      }
      for (std::size_t i = 0; i < gained.size(); ++i) {
        const auto& owner = all.owners[k][i];
        const double share = owner ? fine.wet[i] / (4 * coarse.wet[*owner]) : 0.0;
        EXPECT_NEAR(gained[i], owner ? share * coarse_gained[*owner] : 0.0, 1e-9)
            << column << ", grid " << k << ", cell " << i;
      }
    }
  }
}

TEST(DispersionGrid, KeepsTheResistancesOfWaterWithoutWalls) {
  Grids all(basinWith([](int, int) { return false; }));
  const std::vector<DispersionGrid> before = all.grids;
  fitResistances(all.grids, all.owners);
  for (std::size_t k = 0; k < before.size(); ++k) EXPECT_EQ(all.grids[k].resistance_pm, before[k].resistance_pm);
}

TEST(DispersionGrid, LowersResistanceAtTheEndOfAWall) {
  Grids all(withWallAt(16));
  const std::vector<DispersionGrid> before = all.grids;
  fitResistances(all.grids, all.owners);
  EXPECT_EQ(all.grids[0].resistance_pm, before[0].resistance_pm);
  const DispersionGrid& coarse = all.grids[1];
  // The wall closes the faces between the columns 7 and 8 from row 4 on. Flux turns around its end in row 3: with a
  // square root of the distance as potential, mean levels and flux make 0.75 to 0.95 of the resistance.
  EXPECT_EQ(coarse.open[coarse.at(7, 4)][0], 0.0);
  const double at_end = coarse.resistance_pm[coarse.at(7, 3)][0];
  EXPECT_GT(at_end, 0.75);
  EXPECT_LT(at_end, 0.95);
  EXPECT_EQ(coarse.resistance_pm[coarse.at(2, 2)], before[1].resistance_pm[coarse.at(2, 2)]);
}

TEST(DispersionGrid, FitsBasinsThatAWallDividesAndPuddles) {
  Grids divided(basinWith([](int x, int) { return x == 13; }));
  Grids puddles(basinWith([](int x, int z) { return x % 3 != 1 || z % 5 == 0; }));
  Grids dry(basinWith([](int, int) { return true; }));
  for (Grids* each : {&divided, &puddles, &dry}) {
    fitResistances(each->grids, each->owners);
    for (const DispersionGrid& grid : each->grids) {
      for (std::size_t i = 0; i < grid.wet.size(); ++i) {
        for (std::size_t axis = 0; axis < 2; ++axis) {
          if (grid.open[i][axis] <= 0.0) continue;
          EXPECT_GE(grid.resistance_pm[i][axis], 0.3);
          EXPECT_LE(grid.resistance_pm[i][axis], 2.5);
        }
      }
    }
  }
}

}  // namespace
}  // namespace spindrift::sim
