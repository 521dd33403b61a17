// Include in fluid_surface.frag, behind its uniforms: where the liquid is, and how its surface lies. WAVE, GLASS as there.

// White water is torn: its density less that of the air in it, and how far that varies.
#ifdef WAVE
const float kAiry = 0.45, kTorn = 0.25;  // what is left of a clump are its drops
const float kLaceRadii = 31.0;           // one tile of the noise
const float kSlopeRadii = 2.0;           // slopes are taken over so much to each side
#else
#ifdef GLASS
const float kAiry = 0.3, kTorn = 0.25;
const vec2 kRough = vec2(0.14, 0.04);  // of fast water, coarse and fine, as density
#else
const float kAiry = 0.08, kTorn = 0.1;
const vec2 kRough = vec2(0.09, 0.01);
#endif
const float kLaceRadii = 22.0;
const float kSlopeRadii = 3.0;
#endif
// Halvings of a step, to find the surface.
const int kHalvings = 5;

// Noise; `at`: in particle radii.
float lumps(vec3 at) {
  at /= kLaceRadii;
  return texture(u_noise, at.xy + 0.37 * at.z).r + texture(u_noise, at.zy + 0.37 * at.x).r - 0.5;
}

// Density over that of the surface, and its white share: white water is torn.
vec2 liquidAt(vec3 at_m) {
#ifndef WAVE
  // Level toward the glass, from which the particles keep away.
  vec2 inside = clamp(at_m.xz, u_volume_min_m.xz + 2.0 * u_radius_m, u_volume_max_m.xz - 2.0 * u_radius_m);
  bool is_beside_wall = inside != at_m.xz;
  at_m.xz = inside;
#endif
  vec3 density = volumeAt(at_m);
  float white = density.g / max(density.r, 1e-3);
  if (density.r > 0.6 * kSurface && white > 0.05) {
    float torn = lumps(at_m / u_radius_m);
    density.r -= white * (kAiry + kTorn * torn);
#ifdef GLASS
    // Seen from near, a little air leaves water clear.
    white *= smoothstep(0.15, 0.75, white);
#endif
#ifndef WAVE
    white *= clamp(0.85 + 1.1 * torn, 0.0, 1.0);
#endif
  }
#ifndef WAVE
  // The surface of water that moves fast is rough.
  if (density.b > 0.05 && density.r < 0.9 && !is_beside_wall)
    density.r += density.b * (kRough.x * lumps(1.3 * at_m / u_radius_m) + kRough.y * lumps(3.7 * at_m.zyx / u_radius_m));
#endif
  return vec2(density.r - kSurface, white);
}

// Where the ray crosses the surface between two lengths of which one lies in the liquid.
float crossing(vec3 from, vec3 ray, float a_m, float b_m) {
  bool is_end_inside = liquidAt(from + ray * b_m).x > 0.0;
  for (int i = 0; i < kHalvings; ++i) {
    float middle_m = 0.5 * (a_m + b_m);
    if ((liquidAt(from + ray * middle_m).x > 0.0) == is_end_inside) b_m = middle_m;
    else a_m = middle_m;
  }
  return b_m;
}

float densityAt(vec3 at_m) {
#ifdef WAVE
  return volumeAt(at_m).r;
#else
  return liquidAt(at_m).x;
#endif
}

vec3 normalAt(vec3 at_m) {
  vec2 apart_m = vec2(kSlopeRadii * u_radius_m, 0.0);
  vec3 slope = vec3(densityAt(at_m + apart_m.xyy) - densityAt(at_m - apart_m.xyy), densityAt(at_m + apart_m.yxy) - densityAt(at_m - apart_m.yxy), densityAt(at_m + apart_m.yyx) - densityAt(at_m - apart_m.yyx));
  return -slope / max(length(slope), 1e-5);
}
