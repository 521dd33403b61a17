// Surface frames → the elevation at the time shown, in whole fractions of a quantum: R32I can be drawn to everywhere and keeps every
// bit, unlike half floats.
// Reads u_before, u_from, u_to, u_after: int16 elevations in quanta. Adds u_dents, the dents of one's own fingers (water/local_ripple.ts), and
// fills the dents of u_hulls (water/waterlines_pass.ts).

uniform isampler2D u_before;
uniform isampler2D u_from;
uniform isampler2D u_to;
uniform isampler2D u_after;
uniform int u_stride;    // frame samples per texel
uniform vec4 u_weights;  // of the frames, times quantum over unit of the result

const int kDentsMax = 16;
uniform int u_dent_count;
uniform vec4 u_dents[kDentsMax];  // x, z, radius, elevation in the middle [m]
uniform vec2 u_water_m;  // size of the water along x and z
uniform float u_unit_m;

const int kHullsMax = 64;
uniform int u_hull_count;
uniform vec4 u_hulls[3 * kHullsMax];

layout(location = 0) out int elevation;

vec2 placeOf(ivec2 at, ivec2 n) { return ((vec2(at) + 0.5) / vec2(n) - 0.5) * u_water_m; }

float dentsM(vec2 here_m) {
  float sum_m = 0.0;
  for (int k = 0; k < u_dent_count; ++k) {
    vec2 away = (here_m - u_dents[k].xy) / u_dents[k].z;
    float q2 = dot(away, away);
    if (q2 < 12.0) sum_m += u_dents[k].w * (1.0 - q2) * exp(-q2);
  }
  return sum_m;
}

// Most by which water rises to a hull, over what its weight pressed down; height of the waterline over the water, in draughts, from which on
// a hull has left it.
const float kMostPressed = 3.0;
const vec2 kAloftDraughts = vec2(2.0, 3.0);
// Place of the bow wave ahead of a hull's middle, and its half length and width, in halves of the hull's.
const float kBowAt = 0.8;
const vec2 kBowSize = vec2(0.5, 0.75);

/// The elevation with what hulls have pressed down raised to their waterlines, and with their bow waves.
float filledM(vec2 here_m, float elevation_m) {
  for (int k = 0; k < u_hull_count; ++k) {
    vec4 place = u_hulls[3 * k], size = u_hulls[3 * k + 1], line = u_hulls[3 * k + 2];
    vec2 away_m = here_m - place.xy;
    vec2 at_m = vec2(dot(away_m, place.zw), dot(away_m, vec2(-place.w, place.z)));
    vec2 at = at_m / size.xy;
    vec2 q = at * at;
    if (max(q.x, q.y) > 4.0) continue;
    float gap_m = line.x + dot(at_m, line.yz) - elevation_m;
    float pressed_m = size.z * exp(-dot(q, q));
    elevation_m += clamp(gap_m, 0.0, kMostPressed * pressed_m) * (1.0 - smoothstep(kAloftDraughts.x, kAloftDraughts.y, gap_m / size.w));
    vec2 bow = (at - vec2(kBowAt, 0.0)) / kBowSize;
    elevation_m += line.w * exp(-dot(bow, bow));
  }
  return elevation_m;
}

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy) * u_stride + u_stride / 2;
  vec4 samples = vec4(texelFetch(u_before, at, 0).r, texelFetch(u_from, at, 0).r, texelFetch(u_to, at, 0).r, texelFetch(u_after, at, 0).r);
  vec2 here_m = placeOf(at, textureSize(u_from, 0));
  float units = dot(samples, u_weights);
  if (u_hull_count > 0) units = filledM(here_m, units * u_unit_m) / u_unit_m;
  if (u_dent_count > 0) units += dentsM(here_m) / u_unit_m;
  elevation = int(round(units));
}
