#include <algorithm>
#include <cmath>

#include <shared/groups.h>

#include <spindrift/effects/splash_tiles.h>

namespace spindrift::sim {
namespace {

std::uint32_t tilesAlong(std::uint32_t cells_count) {
  return (cells_count + SPLASH_TILE - 1) / SPLASH_TILE;
}

/// One axis of the grid.
struct Axis {
  std::int64_t cells_count = 0;
  double cell_m = 0.0;
  bool is_periodic = false;

  /// Calls use(tile) for each tile with a cell that is within reach_m of a position, or whose faces are.
  template <typename Use>
  void forEachTile(double at_m, double reach_m, Use use) const {
    const double half_m = 0.5 * cell_m * static_cast<double>(cells_count);
    const auto cellAt = [&](double position_m) {
      return static_cast<std::int64_t>(std::floor((position_m + half_m) / cell_m));
    };
    std::int64_t first = cellAt(at_m - reach_m) - 1;
    std::int64_t last = cellAt(at_m + reach_m) + 1;
    if (!is_periodic || last - first >= cells_count) {
      first = is_periodic ? 0 : std::max<std::int64_t>(first, 0);
      last = is_periodic ? cells_count - 1 : std::min(last, cells_count - 1);
    }
    while (first <= last) {
      const std::int64_t cell = (first % cells_count + cells_count) % cells_count;
      use(static_cast<std::uint32_t>(cell / SPLASH_TILE));
      first += std::min<std::int64_t>(SPLASH_TILE - cell % SPLASH_TILE, cells_count - cell);
    }
  }
};

}  // namespace

SplashTiles::SplashTiles(const WaveLayout& wave)
    : wave_(wave),
      count_x_(tilesAlong(wave.count_x)),
      position_of_tile_(std::size_t{count_x_} * tilesAlong(wave.count_z)) {}

std::span<const shared::SplashTile> SplashTiles::list(const shared::EventUniforms& events) {
  if (!listed_.empty()) std::ranges::fill(position_of_tile_, 0u);
  listed_.clear();
  const Axis along_x{wave_.count_x, wave_.cell_m, wave_.is_periodic_x};
  const Axis along_z{wave_.count_z, wave_.cell_m, wave_.is_periodic_z};
  for (std::uint32_t k = 0; k < events.splash_count; ++k) {
    const shared::EventUniform& splash = events.splashes[k];
    const double reach_m = double{SPLASH_REACH} * splash.radius_m;
    along_z.forEachTile(splash.z_m, reach_m, [&](std::uint32_t z) {
      along_x.forEachTile(splash.x_m, reach_m, [&](std::uint32_t x) {
        std::uint32_t& listed = position_of_tile_[x + count_x_ * z];
        if (listed == 0) {
          listed_.push_back({.place = x | z << 12, .splashes = {}});
          listed = static_cast<std::uint32_t>(listed_.size());
        }
        shared::SplashTile& tile = listed_[listed - 1];
        tile.place |= 1u << (24 + k / 32);
        tile.splashes[k / 32] |= 1u << k % 32;
      });
    });
  }
  return listed_;
}

}  // namespace spindrift::sim
