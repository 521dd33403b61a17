// Adds the displacement of effects to the flow's transfer: TRANSFER holds both when wave/given_share.comp limits it.
#ifndef SPINDRIFT_DISPLACEMENT
#define SPINDRIFT_DISPLACEMENT

#include "wave/transfer.glsl"
#include "wave/water_column.glsl"

layout(binding = ELEVATION) uniform isamplerBuffer elevation;
layout(std430, binding = TRANSFER) restrict buffer Transfer { Units transfer[]; };
layout(std430, binding = LIMIT_ARGS) restrict buffer LimitArgs { uint limit_args[]; };

/// The cells toward +x and +z of cell i.
ivec2 nextCells(ivec2 cell, ivec2 n) {
  return ivec2(wrapped(cell.x + 1, n.x) + n.x * cell.y, cell.x + n.x * wrapped(cell.y + 1, n.y));
}

#if DISPERSE
/// 1 up to where the surface stands once the depth high, 0 from twice the depth on: thousands of effects would pile up
/// water before walls, and where short waves are slow it would stay there.
float roomAt(int i) {
  return clamp(2.0 - metres(texelFetch(elevation, i).x) / sim.wave_depth_m, 0.0, 1.0);
}
#endif

/// Shares of what effects move through the faces that a cell owns: in xy toward +x and +z, in zw the other way.
vec4 effectShares(ivec2 cell, ivec2 next, ivec2 n) {
#if DISPERSE
  const float here = roomAt(cell.x + n.x * cell.y);
  return taperOf(cell, n).xyxy * vec4(roomAt(next.x), roomAt(next.y), here, here);
#else
  return vec4(1.0);
#endif
}

/// What passes of an effect's flow or displacement through the faces toward +x and +z.
vec2 passing(vec2 v, vec4 shares) {
  return v * mix(shares.zw, shares.xy, greaterThan(v, vec2(0.0)));
}

/// Shares of a stroke's displacement through the faces toward +x and +z: 1 where the surface is within highest_m of its
/// rest, 0 from twice that on. `away_m`: how far it is from there at the cell and those toward +x and +z. Stirring at the pace
/// of a basin's own waves would pile them up. The same share for both directions, so that a dent that comes and goes pumps no
/// water.
vec2 strokeShares(vec3 away_m, float highest_m) {
  return clamp(2.0 - max(away_m.xx, away_m.yz) / highest_m, 0.0, 1.0);
}

/// Adds to the faces toward +x and +z of cell i, as far as they are open; `next`: nextCells(). No other invocation of the pass may
/// add to them.
void addTransfers(int i, ivec2 next, Flow open, ivec2 units) {
  units *= ivec2(greaterThan(open.xy, vec2(0.0)));
  if (units == ivec2(0)) return;
  Units sum = transfer[i];
  sum.xy += units;
  transfer[i] = sum;
  const uint held = heldUnits(texelFetch(elevation, i).x, stillDepth(i));
  const uint held_x = heldUnits(texelFetch(elevation, next.x).x, stillDepth(next.x));
  const uint held_z = heldUnits(texelFetch(elevation, next.y).x, stillDepth(next.y));
  if ((units.x != 0 && mayEmpty(sum.x, held, held_x)) || (units.y != 0 && mayEmpty(sum.y, held, held_z))) limit_args[0] = limitGroups();
}

#endif
