// Water through the faces of wave cells, in integer units. One invocation, that of the cell which owns the face,
// computes a face's transfer and stores it in TRANSFER; both cells of the face then read the same integer. So one cell
// gains what the other loses, whatever a compiler does with the floating-point expressions before.
#ifndef SPINDRIFT_TRANSFER
#define SPINDRIFT_TRANSFER

#include "shared/fixed_point.h"

/// Flow times `units` (dt/dx in units), rounded; 0 for a non-finite or excessive flow (diagnostics count it).
int transferUnits(float flow, float units) {
  const float t = flow * units;
  return abs(t) < TRANSFER_MAX_UNITS ? int(round(t)) : 0;
}

float metres(int units) { return float(units) * ELEVATION_UNIT_M; }

#endif
