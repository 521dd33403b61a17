// Include: the sea outside the simulated square, and the simulated water's share. Sides in the order +x, -x, +z, -z.
uniform sampler2D u_swell;    // elevation (m), slope along x, slope along z
#include <ripples>
uniform vec4 u_blend_beyond_m;
uniform vec4 u_blend_width_m;

// 1 where the water is the simulated one, 0 where it is the sea.
float simulatedShare(vec2 at, vec2 extent_m) {
  vec4 inside_m = 0.5 * extent_m.xxyy - vec4(at.x, -at.x, at.y, -at.y);
  vec4 share = clamp((inside_m + u_blend_beyond_m) / u_blend_width_m, 0.0, 1.0);
  share = share * share * (3.0 - 2.0 * share);
  return min(min(share.x, share.y), min(share.z, share.w));
}

// Distance from the simulated water; 0 inside.
float awayFromWater(vec2 at, vec2 extent_m) { return length(max(abs(at) - 0.5 * extent_m, 0.0)); }

// Foam of crests that curl over (curvature in 1/m), where the server sends none.
float crestFoam(float top_m, float curvature) { return smoothstep(0.15, 0.45, top_m) * smoothstep(0.7, 2.4, -curvature); }
