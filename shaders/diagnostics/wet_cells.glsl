// What gauges and points read of the cells around a position.
#ifndef SPINDRIFT_WET_CELLS
#define SPINDRIFT_WET_CELLS

#include "wave/transfer.glsl"
#include "wave/water_column.glsl"

layout(binding = ELEVATION) uniform isamplerBuffer elevation;
layout(binding = FLOW) uniform samplerBuffer flow;

/// A corner, 0 to 3, of the square of cell centres around a position; `place` in cells, whole numbers at centres.
struct Corner {
  ivec2 cell;
  float weight;  // bilinear
};

Corner cornerOf(vec2 place, int corner, ivec2 n) {
  const vec2 first = floor(place);
  const vec2 share = place - first;
  const ivec2 offset = ivec2(corner & 1, corner >> 1);
  const vec2 weights = mix(1.0 - share, share, vec2(offset));
  const ivec2 at = ivec2(first) + offset;
  return Corner(ivec2(waveNeighbourX(at.x, n.x), waveNeighbourZ(at.y, n.y)), weights.x * weights.y);
}

bool isWet(int i, int units) {
#if NONLINEAR
  return heldUnits(units, stillDepth(i)) > 0u;
#elif VARIED
  return stillDepth(i) > 0.0;
#else
  return true;
#endif
}

/// FLOW of a cell, and the conductance of its faces [m]; with NONLINEAR flow alone.
struct Faces {
  StoredFlow flow;
#if !NONLINEAR
  Flow conductance_m;
#endif
};

Faces facesOf(ivec2 cell, ivec2 n) {
  const vec4 stored = texelFetch(flow, cell.x + n.x * cell.y);
#if NONLINEAR
  return Faces(stored);
#else
  return Faces(asFlow(stored), conductanceOf(cell, n));
#endif
}

/// Velocity of a cell [m/s], from its own faces and those of the cells before it along x and z: mean of flow over still depth at
/// its two faces along an axis, 0 at a closed one; with NONLINEAR mean of the velocities in FLOW.
vec2 velocityOf(Faces own, Faces left, Faces before) {
#if NONLINEAR
  return 0.5 * (own.flow.xy + vec2(left.flow.x, before.flow.y));
#else
  const float least_m = 0.05 * sim.wave_depth_m;
  const vec2 after_mps = own.flow.xy / max(own.conductance_m.xy, least_m);
  const vec2 before_mps =
      vec2(left.flow.x, before.flow.y) / max(vec2(left.conductance_m.x, before.conductance_m.y), least_m);
  return 0.5 * (after_mps + before_mps);
#endif
}

#endif
