// What particles brought back to each wave cell in this tick, for coupling/mix.comp. Only with a nonlinear bulk: linear water
// has no momentum of its own that water could bring along.
#ifndef SPINDRIFT_LANDED_WATER
#define SPINDRIFT_LANDED_WATER

#include "shared/bindings.h"
#include "shared/pool.h"

layout(std430, binding = LANDED_WATER) restrict buffer LandedWater { int landed_water[]; };

#endif
