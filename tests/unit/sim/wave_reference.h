// Reference implementation of a wave step in double precision over any bed: momentum, the limit to the water in a cell,
// continuity with sponges or matched layers.
#pragma once

#include <vector>

#include <spindrift/core/scene.h>
#include <spindrift/sim_setup/basin.h>
#include <spindrift/sim_setup/derive.h>

#include "dispersion_reference.h"

namespace spindrift::sim {

/// Ground of n x n wave cells, x fastest.
struct ReferenceBed {
  std::vector<double> depth_m;               ///< still depth; 0 = dry ground
  std::vector<double> flow_loss_per_s;       ///< in addition to the scene's damping
  std::vector<double> elevation_loss_per_s;  ///< in sponges
  std::vector<double> layer_x_per_s;         ///< in matched layers, along x; empty in scenes without them
  std::vector<double> layer_z_per_s;         ///< along z

  ReferenceBed() = default;
  ReferenceBed(const core::Scene& scene, const Basin& basin);
};

/// State of the water at one time. Flow through the faces that a cell owns, in the order of
/// shaders/wave/wave_faces.glsl: toward +x, toward +z, and with the 9-point stencil the two diagonals.
struct ReferenceWater {
  std::vector<double> elevation_m;
  std::vector<double> flow_m2ps;      ///< n x n x 2 (9-point: 4)
  std::vector<double> elevation_x_m;  ///< in matched layers: the part that came through x faces; empty without them
  double lost_m = 0.0;                ///< sum over all cells of the loss in sponges, in all steps so far
  std::size_t limited_count = 0;      ///< cells that lacked water in the last step
};

/// Computes one wave step of linear water (steepening_ratio 0) without external pressure and effects. As in the
/// shaders, `water` holds elevations at the beginning of the step and flows of half a step before. `dispersion` is null
/// in scenes without dispersion.
void referenceFlowStep(const core::Scene& scene, const Derived& derived, const ReferenceBed& bed, ReferenceWater& water,
                       const DispersionReference* dispersion = nullptr);

}  // namespace spindrift::sim
