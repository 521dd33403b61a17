// Moves the particle patch to its target: a position from the host, or the first boat. One invocation.
// Reads BOATS. Writes min and max of x and z in the simulation's uniforms; the patch keeps its size and stays on the water.
// The host need not read back the boat's position; the next pass reads the moved uniforms.
#include "common/finite.glsl"
#include "shared/bindings.h"
#include "shared/dual.h"

#define FOLLOW_PLACE 1
#define FOLLOW_BOAT 2

layout(local_size_x = 1) in;

// The first members of SimUniforms (shared/sim_uniforms.h); all are scalars, so that std140 and std430 agree.
layout(std430, binding = SIM_UNIFORMS_STORAGE) restrict buffer MovableUniforms {
  float min_x_m;
  float min_y_m;
  float min_z_m;
  float max_x_m;
  float max_y_m;
  float max_z_m;
};
uniform float wave_length_m;
uniform float wave_width_m;
uniform float place_x_m;
uniform float place_z_m;
#if FOLLOW == FOLLOW_BOAT
#include "shared/boats.h"
layout(binding = BOATS) uniform samplerBuffer boats;
#endif

void main() {
  vec2 place_m = vec2(place_x_m, place_z_m);
#if FOLLOW == FOLLOW_BOAT
  for (int place = int(boat_place_count) - 1; place >= 0; --place) {
    if (texelFetch(boats, place * BOAT_TEXELS + 1).z >= 0.0) place_m = texelFetch(boats, place * BOAT_TEXELS).xz;
  }
#endif
  const vec2 half_m = 0.5 * vec2(max_x_m - min_x_m, max_z_m - min_z_m);
  const vec2 room_m = max(0.5 * vec2(wave_length_m, wave_width_m) - half_m, vec2(0.0));
  const vec2 before_m = vec2(min_x_m, min_z_m) + half_m;
  place_m = isNaN(place_m.x + place_m.y) ? before_m : clamp(place_m, -room_m, room_m);
  min_x_m = place_m.x - half_m.x;
  max_x_m = place_m.x + half_m.x;
  min_z_m = place_m.y - half_m.y;
  max_z_m = place_m.y + half_m.y;
}
