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

// 1 in the square whose textures end at its edges, and 0 beyond them, where these repeat their last texels. `place`: 0..1 in the square.
float insideSquare(vec2 place) {
  vec2 inside = smoothstep(0.5, 0.485, abs(place - 0.5));
  return inside.x * inside.y;
}

// Distance from the simulated water; 0 inside.
float awayFromWater(vec2 at, vec2 extent_m) { return length(max(abs(at) - 0.5 * extent_m, 0.0)); }

#ifdef UNEVEN
const float kUnevenM = 0.14;

// Where the field of a position is read. Steepening crests that the simulation keeps as straight as the side they came from are drawn as wind
// and bed make them.
vec2 unevenAt(vec2 at) {
  return at + kUnevenM * (sin(1.1 * at.yx + vec2(0.4, 2.0)) + 0.5 * sin(2.3 * at.yx + vec2(4.1, 0.7)) + 0.2 * sin(5.1 * at.yx + 0.8 * at));
}

// Factor on its elevation and slopes.
float unevenHeight(vec2 at, float top_m) {
  return 1.0 + 0.2 * smoothstep(0.03, 0.3, top_m) * (0.65 * sin(1.7 * at.y + 0.3 * at.x) + 0.35 * sin(4.3 * at.y + 1.3));
}

// A crest leans over toward the shore by so many metres per square metre of its height.
const float kLeanPerM = 0.8;

float leanM(float top_m) { return kLeanPerM * max(top_m, 0.0) * max(top_m, 0.0); }
float leanPerRise(float top_m) { return 2.0 * kLeanPerM * max(top_m, 0.0); }
#endif

uniform float u_torn_by_wind;  // crests foam as if they were curved this many times as much (tornByWind of ripples.ts)

// Foam of crests that curl over (curvature in 1/m).
float crestFoam(float top_m, float curvature) { return smoothstep(0.15, 0.45, top_m) * smoothstep(0.45, 1.8, -curvature); }
