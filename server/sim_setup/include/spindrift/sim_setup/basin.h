// The bed and the sides of the water for the wave: depths, faces between cells, sponges. Pure functions of the scene.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <spindrift/core/scene.h>
#include <spindrift/sim_setup/derive.h>
#include <spindrift/sim_setup/scene_parts.h>

namespace spindrift::sim {

/// nx x nz cells, x fastest.
struct Basin {
  bool is_flat = false;  ///< no obstacles, beaches or bed, whatever the parameters: one depth, only sides are closed
  std::vector<float> depth_m;  ///< still depth at cell centres; 0 inside obstacles and on dry beaches
  /// Conductance [m] of the faces that a cell owns, in the order of shaders/wave/wave_faces.glsl: toward +x, toward +z,
  /// and the two diagonals of the 9-point stencil. It is the depth at the face (harmonic mean, so 0 beside a dry cell)
  /// times the stencil's weight; 0 across reflecting and absorbing sides. Where waves disperse, which have no
  /// diagonals, the last two are the shares of an effect's displacement that pass the faces toward +x and +z
  /// (shaders/wave/wave_faces.glsl).
  std::vector<std::array<float, 4>> conductance_m;
  /// Input of a wave step for each cell, with the still depth [m] as in depth_m as the third component. With sponges:
  /// rates at which flow and elevation are lost [1/s] (equal in a sponge; flow alone where a beach runs dry), depth, 0.
  /// With matched layers: rate at which flow is lost where a beach runs dry, loss rate of flow and elevation along x,
  /// depth, loss rate along z. With a nonlinear bulk the depth is that of the ground, obstacles included: negative
  /// above the still water, and no beach takes flow.
  std::vector<std::array<float, 4>> bed;
};

/// Returns the elevation [units] of the water of a nonlinear bulk at rest: 0, and the ground where that is higher.
std::vector<std::int32_t> restingElevation(const Basin& basin);

Basin layOutBasin(const core::Scene& scene, const WaveLayout& layout);

/// The ground for particles and boats, nx x nz, for shaders/common/terrain_texels.glsl.
struct Terrain {
  /// Signed distance to the nearest obstacle, its gradient (x, z), still depth (0 on dry ground at the rest level,
  /// negative on land, minus the obstacle's height inside one).
  std::vector<std::array<float, 4>> ground;
  /// Index of the wet cell that receives water falling on this cell: the cell itself, or the nearest wet one.
  std::vector<std::int32_t> landing;
};

Terrain layOutTerrain(const core::Scene& scene, const WaveLayout& layout, const Basin& basin);

}  // namespace spindrift::sim
