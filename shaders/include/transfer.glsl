// Water through the faces of wave cells, in integer units. Both cells of a face compute the same number from the same bits
// (`precise` forbids that a compiler rounds one of them differently), so what one loses the other gains.
#ifndef SPINDRIFT_TRANSFER
#define SPINDRIFT_TRANSFER

#include "shared/fixed_point.h"

/// Flow times `units` (dt/dx in units) rounded; nothing for a flow that is not finite or absurd (diagnostics count it).
int transferUnits(float flow, float units) {
  precise float t = flow * units;
  return abs(t) < TRANSFER_MAX_UNITS ? int(round(t)) : 0;
}

float metres(int units) { return float(units) * ELEVATION_UNIT_M; }

#endif
