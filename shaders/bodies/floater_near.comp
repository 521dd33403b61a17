// Lists for each floater what it can touch in this tick. One invocation per slot.
// Reads FLOATERS, FLOATER_PLACES, FLOATER_TILES (bodies/floater_tiles.comp), TERRAIN, BOATS. Writes FLOATER_NEAR.
// Two floaters list each other, unless one has more neighbours than words: it keeps those of the lowest slots.
#include "bodies/floater_texels.glsl"
#include "bodies/floater_tiles.glsl"
#if VARIED
#include "common/terrain.glsl"
#endif
#if HULLS
#include "bodies/boat.glsl"
#endif

layout(local_size_x = FLOATER_GROUP) in;

layout(binding = FLOATER_PLACES) uniform samplerBuffer places;
layout(std430, binding = FLOATER_TILES) restrict readonly buffer FloaterTiles { uint tiles[]; };
layout(std430, binding = FLOATER_NEAR) restrict writeonly buffer FloaterNear { uint near[]; };
#if HULLS
layout(binding = BOATS) uniform samplerBuffer boats;
#endif

/// Whether it can touch the bed, a rock, a side or a boat.
bool isGrounded(vec4 place) {
  const vec2 inside_m = waveHalf_m() - abs(place.xz);
  bool is_grounded = false;
#if !WAVE_PERIODIC_X
  is_grounded = is_grounded || inside_m.x < place.w;
#endif
#if !WAVE_PERIODIC_Z
  is_grounded = is_grounded || inside_m.y < place.w;
#endif
#if VARIED
  const vec4 t = terrainAt(place.xz);
  // The bed rises at most as steeply as this within its reach.
  const float steepest = 1.0;
  is_grounded = is_grounded || t.x < place.w || place.y - place.w * (1.0 + steepest) < -t.w;
#else
  is_grounded = is_grounded || place.y - place.w < -sim.wave_depth_m;
#endif
#if HULLS
  for (int slot = 0; slot < int(boat_place_count); ++slot) {
    vec3 d = texelFetch(boats, slot * BOAT_TEXELS).xyz - place.xyz;
    d.xz = acrossSides(d.xz);
    const float reach_m = place.w + 0.5 * length(texelFetch(boats, slot * BOAT_TEXELS + 4).xyz);
    is_grounded = is_grounded || (texelFetch(boats, slot * BOAT_TEXELS + 1).z >= 0.0 && dot(d, d) < reach_m * reach_m);
  }
#endif
  return is_grounded;
}

/// Largest gap between the boxes around two floaters along the axes of the first. [m]
float gapAlong(Floater b, Floater o, vec3 apart_m) {
  const vec3 d = abs(rotatedBack(b.rotation, apart_m));
  vec3 reach_m = b.half_m;
  for (int axis = 0; axis < 3; ++axis)
    reach_m += o.half_m[axis] * abs(rotatedBack(b.rotation, rotated(o.rotation, vec3(axis == 0, axis == 1, axis == 2))));
  const vec3 gap_m = d - reach_m;
  return max(gap_m.x, max(gap_m.y, gap_m.z));
}

void main() {
  const uint own = gl_GlobalInvocationID.x;
  const uint slots = uint(near.length()) / FLOATER_NEAR_WORDS;
  if (own >= slots) return;
  const vec4 place = texelFetch(places, int(own));
  const Floater b = floaterAt(own);
  const float margin_m = place.w - reachOf(b);
  const uint first = own * FLOATER_NEAR_WORDS;
  uint count = 0u;
  if (place.w > 0.0) {
    const ivec4 span = tileSpan(place);
    const uint words = (slots + 31u) / 32u;
    for (uint word = 0u; word < words; ++word) {
      uint listed = 0u;
      for (int z = span.z; z <= span.w; ++z)
        for (int x = span.x; x <= span.y; ++x) listed |= tiles[tileAt(x, z, words) + word];
      while (listed != 0u && count < FLOATER_NEAR_WORDS - 1u) {
        const uint other = 32u * word + uint(findLSB(listed));
        const vec4 at = texelFetch(places, int(other));
        vec3 d = at.xyz - place.xyz;
        d.xz = acrossSides(d.xz);
        const float reach_m = at.w + place.w;
        const Floater o = floaterAt(other);
        vec3 apart_m = middleOf(o) - middleOf(b);
        apart_m.xz = acrossSides(apart_m.xz);
        const float gap_m = max(gapAlong(b, o, apart_m), gapAlong(o, b, -apart_m));
        if (other != own && dot(d, d) <= reach_m * reach_m && gap_m <= margin_m + at.w - reachOf(o)) {
          ++count;
          near[first + count] = other;
        }
        listed &= listed - 1u;
      }
    }
    if (isGrounded(place)) count += FLOATER_GROUNDED;
  }
  near[first] = count;
}
