// Include in water.frag: the relief of foam, and how the sun lights it. Old foam is a network around holes; foam that has just begun is a
// heap of domes with creases between them. After u_noise, u_lace_m and sky.glsl.

// Slope of the relief per difference of the lace between two points that are kReliefTiles of its tile apart, and the most that is drawn.
#ifndef GLASS
const float kReliefSlope = 5.5;
#else
const float kReliefSlope = 2.5;  // fine froth
#endif
const float kReliefTiles = 0.02, kSteepest = 1.1;

// Size of the billows of masses of foam, and the step over which their slope is taken, in tiles of the lace; slope per difference of the noise.
const float kBillows = 3.1, kBillowStep = 0.12, kBillowSlope = 1.9;

// Height of the lace, 0..1 around 0.5. `fresh`: 0 a network, 1 a heap.
float laceAt(vec2 at, float fresh) {
  float wide = texture(u_noise, at / u_lace_m).r;
  float middle = texture(u_noise, at.yx / (0.31 * u_lace_m)).r;
  float fine = texture(u_noise, at / (0.11 * u_lace_m)).r;
  float broad = texture(u_noise, at.yx / (2.7 * u_lace_m)).r;
  return mix(0.5 * wide + 0.34 * middle + 0.16 * fine, 1.0 - (0.3 * broad + 0.34 * wide + 0.24 * middle + 0.12 * fine), fresh);
}

// Foam that is drawn where the server streams so much. Old foam is a network; only what has just begun is a body.
float shownFoam(float streamed) {
#ifndef GLASS
  return streamed * (0.65 + 0.35 * streamed * streamed);
#else
  // The low waves of a tank are seen from near.
  return smoothstep(0.0, 0.8, streamed);
#endif
}

// Light of foam of this `lace` on water with this `normal`. `blur`: width of a pixel in tiles of the lace.
vec3 foamLight(vec2 at, float lace, float fresh, vec3 normal, float sunlit_share, float blur) {
  vec2 toward_sun = u_sun_direction.xz * inversesqrt(dot(u_sun_direction.xz, u_sun_direction.xz) + 1e-4);
  float step_tiles = max(kReliefTiles, 0.7 * blur);
  float rise = laceAt(at + step_tiles * u_lace_m * toward_sun, fresh) - lace;
  float slope = clamp(kReliefSlope * rise * kReliefTiles / step_tiles, -kSteepest, kSteepest);
  vec3 bent = normalize(normal - slope * vec3(toward_sun.x, 0.0, toward_sun.y));
#ifdef OPEN_SEA
  // Masses of it are billows.
  float broad = texture(u_noise, at.yx / (kBillows * u_lace_m)).r;
  float billow = texture(u_noise, (at + kBillowStep * u_lace_m * toward_sun).yx / (kBillows * u_lace_m)).r - broad;
  bent = normalize(bent - clamp(kBillowSlope * fresh * billow, -kSteepest, kSteepest) * vec3(toward_sun.x, 0.0, toward_sun.y));
#endif
  // Light that enters at one side of a lump leaves it at the others.
  float sun = sunlit_share * clamp(0.25 + 0.75 * dot(bent, u_sun_direction), 0.0, 1.0);
  // Little of the sky is seen from a crease.
  float open = mix(0.3 + 1.0 * lace, 0.8, smoothstep(0.05, 0.3, blur));
  return vec3(0.91, 0.95, 0.97) * open * (1.1 * u_sun_light * sun + u_ambient_up * vec3(1.0, 0.96, 0.9));
}
