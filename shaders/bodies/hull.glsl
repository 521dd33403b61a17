// Hulls push particles: out of an ellipsoid of the hull's length, height and beam, along the line from its centre.
#ifndef SPINDRIFT_HULL
#define SPINDRIFT_HULL

#include "bodies/boat.glsl"
#include "wave/wave_cell.glsl"

layout(binding = BOATS) uniform samplerBuffer boats;

void pushOutOfHulls(inout vec3 x, inout vec3 v) {
  for (int place = 0; place < int(boat_place_count); ++place) {
    const vec4 pose = texelFetch(boats, place * BOAT_TEXELS);
    const float age_s = texelFetch(boats, place * BOAT_TEXELS + 1).z;
    const vec4 motion = texelFetch(boats, place * BOAT_TEXELS + 2);
    const vec3 half_m = 0.5 * texelFetch(boats, place * BOAT_TEXELS + 4).xzy;
    const vec2 d = acrossSides(x.xz - pose.xz);
    const vec2 f = forwardOf(pose.w);
    const vec2 s = starboardOf(pose.w);
    const vec3 q = vec3(dot(d, f), x.y - pose.y, dot(d, s)) / half_m;
    const float r = length(q);
    if (age_s < 0.0 || r >= 1.0) continue;
    const vec3 out_m = q * (1.0 / max(r, 1e-3) - 1.0) * half_m;
    x += vec3(f.x * out_m.x + s.x * out_m.z, out_m.y, f.y * out_m.x + s.y * out_m.z);
    const vec3 local_normal = normalize(q / half_m + vec3(0.0, 1e-6, 0.0));
    const vec3 normal = vec3(f.x * local_normal.x + s.x * local_normal.z, local_normal.y, f.y * local_normal.x + s.y * local_normal.z);
    const vec3 hull_mps = vec3(f.x * motion.x + s.x * motion.y, motion.z, f.y * motion.x + s.y * motion.y);
    v += normal * max(dot(hull_mps - v, normal), 0.0);
  }
}

#endif
