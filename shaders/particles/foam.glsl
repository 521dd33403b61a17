// White water from low pressure: a particle with few neighbours was thrown out of the water (thesis 3.6.2).
#ifndef SPINDRIFT_FOAM
#define SPINDRIFT_FOAM

#include "shared/sim_uniforms.h"

/// Foam 0..1 after one substep. Its source rises from zero at 0.7 of the threshold deficit to one at the threshold;
/// without a source, foam fades by exp(-dt / lifetime).
float foamStep(float foam, float density_ratio) {
  const float deficit = 1.0 - density_ratio;
  const float source = clamp((deficit / sim.foam_deficit_ratio - 0.7) / 0.3, 0.0, 1.0);
  return max(source, foam * sim.foam_keep_ratio);
}

/// Second source, spray: 0 for a particle with at least foam_neighbours neighbours, 1 for one with at most half of
/// them.
float neighbourFoam(float neighbours) {
  return clamp(2.0 - 2.0 * neighbours / sim.foam_neighbours, 0.0, 1.0);
}

#endif
