// One substep on the device beside the same substep in double precision (water_reference.h).
#pragma once

#include <cstddef>

#include <spindrift/sim/water_sim.h>

namespace spindrift::study {

struct StepErrors {
  double density_ratio = 0.0;  ///< largest |rho - reference| / reference
  /// Largest error of what moved a particle over the mean of it: its acceleration, or its correction where the solver
  /// is position-based.
  double motion_ratio = 0.0;
  std::size_t compared_count = 0;  ///< particles that met neither floor nor side in the step
};

/// The scene as compareStep() needs it: one short substep a tick, one iteration, no viscosity after a correction.
core::Scene oneSubstepScene(core::Scene scene);

/// A state of the scene's own size: the starting lattice, moved by up to 0.3 of the spacing, with random speeds, and a
/// wavy surface.
sim::StateCopy stirredState(sim::WaterSim& water);

/// Runs one substep from a stirred state. `water` is of a oneSubstepScene(). Errors: the device's.
core::Result<StepErrors> compareStep(sim::WaterSim& water);

}  // namespace spindrift::study
