// The tiles of the wave grid that splashes reach; wave/splash.comp visits no others.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <shared/event_uniforms.h>

#include <spindrift/sim_setup/derive.h>

namespace spindrift::sim {

class SplashTiles {
 public:
  explicit SplashTiles(const WaveLayout& wave);

  /// Number of tiles of the grid: list() never returns more.
  [[nodiscard]] std::size_t count() const { return position_of_tile_.size(); }

  /// Returns every tile that a splash reaches, each once, with its splashes. Valid until the next call.
  std::span<const shared::SplashTile> list(const shared::EventUniforms& events);

 private:
  WaveLayout wave_;
  std::uint32_t count_x_;                        ///< tiles along x
  std::vector<std::uint32_t> position_of_tile_;  ///< in listed_, plus 1; 0 = not listed
  std::vector<shared::SplashTile> listed_;
};

}  // namespace spindrift::sim
