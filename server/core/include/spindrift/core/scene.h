// The scene as the simulation reads it: plain values in SI units, already validated against the ranges in proto.
// core::Scene and all that it holds (Splash, Boat, Side, ...) are generated from proto/spindrift/v1/scene.proto, with
// the same names, defaults and comments: read them there, or in the build folder (spindrift/core/scene_types.h). The
// scene module converts; sim::derive() computes step sizes and layouts. Axes: right-handed, y up, rest water level y =
// 0, domain centred on the origin, x and z horizontal.
#pragma once

#include <cstdint>

#include <spindrift/core/cell_counts.h>
#include <spindrift/core/scene_types.h>

namespace spindrift::core {

/// At most this many boats, and gauges, in a scene.
inline constexpr std::uint32_t kMaxBoats = 64;
inline constexpr std::uint32_t kMaxFloaters = 1024;
inline constexpr std::uint32_t kMaxGauges = 64;

/// Returns the cells of the wave's grid.
[[nodiscard]] inline WaveCells waveCellsOf(const WaveScene& wave) {
  return waveCellsOf(wave.resolution_count, wave.side_m, wave.width_m);
}

/// Sets all four sides.
inline void setBoundaries(WaveScene& wave, WaveBoundary all) {
  wave.boundary_minus_x = wave.boundary_plus_x = wave.boundary_minus_z = wave.boundary_plus_z = all;
}

}  // namespace spindrift::core
