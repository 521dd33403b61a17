// Adds the displacement of effects to the flow's transfer: TRANSFER holds both when wave/given_share.comp limits it.
#ifndef SPINDRIFT_DISPLACEMENT
#define SPINDRIFT_DISPLACEMENT

#include "wave/transfer.glsl"
#include "wave/water_column.glsl"

layout(binding = ELEVATION) uniform isamplerBuffer elevation;
layout(std430, binding = TRANSFER) restrict buffer Transfer { int transfer[]; };
layout(std430, binding = LIMIT_ARGS) restrict buffer LimitArgs { uint limit_args[]; };

/// Adds to a face of the cell `from`; `face` 0 leads to +x, 1 to +z, and `to` is the cell there. The sum is an integer,
/// so overlapping effects give the same bits in any order.
void addTransfer(int from, int to, uint face, int units) {
  if (units == 0) return;
  const int sum = atomicAdd(transfer[int(OWNED_FACES) * from + int(face)], units) + units;
  const uint held_from = heldUnits(texelFetch(elevation, from).x, stillDepth(from));
  const uint held_to = heldUnits(texelFetch(elevation, to).x, stillDepth(to));
  if (mayEmpty(sum, held_from, held_to)) limit_args[0] = limitGroups();
}

#endif
