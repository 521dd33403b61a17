// What a floater can reach in a tick, and the tiles of the water that this touches.
#ifndef SPINDRIFT_FLOATER_REACH
#define SPINDRIFT_FLOATER_REACH

#include "bodies/floater.glsl"

layout(binding = FLOATERS) uniform samplerBuffer floaters;
uniform uint tile_words_count;

/// Centre of mass, and the radius of what it can touch before the end of the tick; 0 for a free slot. [m]
vec4 floaterPlace(int slot) {
  vec4 t[FLOATER_TEXELS];
  for (int k = 0; k < FLOATER_TEXELS; ++k) t[k] = texelFetch(floaters, slot * FLOATER_TEXELS + k);
  const Floater b = unpackFloater(t);
  if (b.age_s < 0.0) return vec4(0.0);
  const float path_m = sim.tick_s * (length(b.velocity_mps) + sim.tick_s * length(b.acceleration_mps2));
  return vec4(b.centre_m, reachOf(b) + path_m + 0.02 * b.half_m.x);
}

/// First and last tile along x, and along z. Beyond the sides they go on, and tileAt() wraps or clamps them.
ivec4 tileSpan(vec4 place) {
  const vec2 per_m = float(FLOATER_TILES_PER_AXIS) / (2.0 * waveHalf_m());
  const vec2 low = (place.xz - place.w + waveHalf_m()) * per_m;
  const vec2 high = (place.xz + place.w + waveHalf_m()) * per_m;
  const float n = float(FLOATER_TILES_PER_AXIS);
  // Clamped, because a non-finite position becomes an index.
  const ivec2 first = ivec2(floor(clamp(low, vec2(-n), vec2(2.0 * n - 1.0))));
  const ivec2 last = min(ivec2(floor(clamp(high, vec2(-n), vec2(2.0 * n - 1.0)))), first + FLOATER_TILES_PER_AXIS - 1);
  return ivec4(first.x, last.x, first.y, last.y);
}

uint tileAt(int x, int z) {
  return uint(waveNeighbourX(x, FLOATER_TILES_PER_AXIS) + FLOATER_TILES_PER_AXIS * waveNeighbourZ(z, FLOATER_TILES_PER_AXIS));
}

#endif
