// The cells along the sides of the water in MAKER_FLOW.
#ifndef SPINDRIFT_MAKER_SIDE
#define SPINDRIFT_MAKER_SIDE

#include "shared/maker_uniforms.h"

/// Place of the first cell of a side. n: cells along x and z.
int makerBegin(uint side, ivec2 n) {
  return side == MAKER_MINUS_X ? 0 : (side == MAKER_PLUS_X ? n.y : (side == MAKER_MINUS_Z ? 2 * n.y : 2 * n.y + n.x));
}

#endif
