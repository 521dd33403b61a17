// The slowest standing waves of basins with thin walls: the dispersion's operator in double precision beside Airy's
// frequency, by Rayleigh quotients.
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "basin_modes.h"
#include "dispersion_reference.h"

namespace spindrift::study {
namespace {

constexpr int kSide = 96;

core::Breakwater wall(double x_cells, double z_cells, double length_cells, double width_cells, double heading_deg,
                      double cell_m) {
  return {.x_m = (x_cells - kSide / 2.0) * cell_m,
          .z_m = (z_cells - kSide / 2.0) * cell_m,
          .length_m = length_cells * cell_m,
          .width_m = width_cells * cell_m,
          .heading_deg = heading_deg};
}

/// Largest relative error of the frequencies of the eight slowest modes, in percent.
double largestErrorPercent(const core::Scene& scene) {
  const sim::WaveLayout layout = *sim::derive(scene)->wave;
  const sim::Basin basin = sim::layOutBasin(scene, layout);
  const sim::DispersionReference reference(sim::layOutDispersion(layout, basin));
  const sim::DispersionLevel& grid = reference.dispersion().levels.front();
  double largest = 0.0;
  for (const BasinMode& mode : lowestModes(layout, basin, 8)) {
    const auto faces = reference.apply(mode.shape);
    double energy = 0.0;
    double square = 0.0;
    for (int z = 0; z < kSide; ++z) {
      for (int x = 0; x < kSide; ++x) {
        const std::size_t i = grid.index(x, z);
        energy += faces[i][0] * (mode.shape[grid.index(x + 1, z)] - mode.shape[i]) +
                  faces[i][1] * (mode.shape[grid.index(x, z + 1)] - mode.shape[i]);
        square += mode.shape[i] * mode.shape[i];
      }
    }
    const double wanted = mode.k_radpm * std::tanh(mode.k_radpm * scene.wave->depth_m);
    const double got = energy / square / (layout.cell_m * layout.cell_m);
    largest = std::max(largest, 100 * std::abs(std::sqrt(got / wanted) - 1));
  }
  return largest;
}

TEST(WalledBasins, HaveSlowModesOfAirysFrequency) {
  using Walls = std::vector<core::Obstacle>;
  struct Water {
    double depth_m, cell_m, most_percent;
  };
  for (const Water& water : {Water{1.2, 1.0 / 6, 1.0}, Water{4.0, 0.1, 4.0}}) {
    const auto at = [&](double x, double z, double length, double width, double heading_deg) {
      return wall(x, z, length, width, heading_deg, water.cell_m);
    };
    for (const auto& [name, walls] :
         {std::pair{"an L, mirrored", Walls{at(47.5, 46, 39.9, 0.9, 90), at(32, 26.5, 31.9, 0.9, 0)}},
          std::pair{"half a wall at an odd column", Walls{at(49.5, 29, 57.9, 0.9, 90)}},
          std::pair{"diagonal", Walls{at(43, 51, 70, 0.9, 45)}}, std::pair{"slanted", Walls{at(43, 51, 80, 1.5, 20)}},
          std::pair{"a gap of 6 cells", Walls{at(50.5, 22, 43.9, 0.9, 90), at(50.5, 73, 45.9, 0.9, 90)}},
          std::pair{"a long island", Walls{at(33.5, 52.5, 50.9, 0.9, 90)}}}) {
      core::Scene scene;
      scene.wave.emplace();
      scene.wave->resolution_count = kSide;
      scene.wave->side_m = kSide * water.cell_m;
      scene.wave->depth_m = water.depth_m;
      scene.wave->dispersion = core::Dispersion::kAiry;
      setBoundaries(*scene.wave, core::WaveBoundary::kReflect);
      scene.obstacles = walls;
      EXPECT_LE(largestErrorPercent(scene), water.most_percent) << name << ", " << water.depth_m << " m deep";
    }
  }
}

}  // namespace
}  // namespace spindrift::study
