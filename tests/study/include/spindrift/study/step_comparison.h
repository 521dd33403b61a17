// Compares one substep on the device with the same substep in double precision (water_reference.h).
#pragma once

#include <cstddef>

#include <spindrift/sim/water_sim.h>

namespace spindrift::study {

struct StepErrors {
  double density_ratio = 0.0;  ///< largest |rho - reference| / reference
  /// Largest error of the particles' motion over its mean: of the acceleration, or of the correction with the
  /// position-based solver.
  double motion_ratio = 0.0;
  std::size_t compared_count = 0;  ///< particles without contact with floor and sides in the step
};

/// Returns the scene as compareStep() needs it: one short substep per tick, one iteration, no viscosity after a
/// correction.
core::Scene oneSubstepScene(core::Scene scene);

/// Returns a state of the same size: the starting lattice, moved by up to 0.3 of the spacing, with random velocities
/// and a wavy surface.
sim::StateCopy stirredState(sim::WaterSim& water);

/// Runs one substep from a stirred state. The scene of `water` must come from oneSubstepScene(). Errors: those of the
/// device.
core::Result<StepErrors> compareStep(sim::WaterSim& water);

}  // namespace spindrift::study
