// Reference implementation of a wave step in double precision over any bed: momentum, the limit to the water in a cell,
// continuity with sponges.
#pragma once

#include <vector>

#include <spindrift/core/scene.h>
#include <spindrift/sim_setup/derive.h>

namespace spindrift::sim {

/// Ground of n x n wave cells, x fastest.
struct ReferenceBed {
  std::vector<double> depth_m;               ///< still depth; 0 = dry ground
  std::vector<double> flow_loss_per_s;       ///< in addition to the scene's damping
  std::vector<double> elevation_loss_per_s;  ///< in sponges
};

/// State of the water at one time. Flow through the faces that a cell owns, in the order of
/// shaders/wave/wave_faces.glsl: toward +x, toward +z, and with the 9-point stencil the two diagonals.
struct ReferenceWater {
  std::vector<double> elevation_m;
  std::vector<double> flow_m2ps;  ///< n x n x 2 (9-point: 4)
  double lost_m = 0.0;            ///< sum over all cells of the loss in sponges, in all steps so far
  std::size_t limited_count = 0;  ///< cells that lacked water in the last step
};

/// Computes one wave step of linear water (steepening_ratio 0) without external pressure and effects. As in the
/// shaders, `water` holds elevations at the beginning of the step and flows of half a step before.
void referenceFlowStep(const core::Scene& scene, const Derived& derived, const ReferenceBed& bed,
                       ReferenceWater& water);

}  // namespace spindrift::sim
