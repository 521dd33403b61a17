// Include in water.frag and fluid_surface.frag: the relief of foam, and how the sun lights it. Old foam is a network around holes; foam that
// has just begun is a heap of domes with creases between them. After u_noise, u_lace_m, sky.glsl and water_optics.glsl.

#include <billows>

// Slope of the relief per difference of the lace between two points that are kReliefTiles of its tile apart, and the most that is drawn
// (kSteepest). Share of the light that reaches the middle height of the lace, and how fast it grows with height: less reaches
// the creases. By how much fresh foam has fewer holes than other foam (kFilled).
#ifndef GLASS
const float kReliefSlope = 7.0, kOpen = 0.7, kCreased = 1.9, kFilled = 0.14;
#else
const float kReliefSlope = 0.9, kOpen = 0.95, kCreased = 0.8, kFilled = 0.08;  // fine froth
#endif
const float kReliefTiles = 0.02, kSteepest = 1.1;

// Step over which the slope of billows is taken, in tiles of the lace; slope per difference of their height.
const float kBillowStep = 0.12, kBillowSlope = 1.9;

// Size of a tile of bubbles, in tiles of the lace, and how much they add to its height.
const float kBubbles = 0.05, kTornByBubbles = 0.4;

// Height of the lace, 0..1 around 0.5. `drawn_m`: by which the water has drawn it out, its fine parts less. `fresh`: 0 a network, 1 a heap.
float laceAt(vec2 at, vec2 drawn_m, float fresh) {
  float wide = texture(u_noise, (at + drawn_m) / u_lace_m).r;
  float middle = texture(u_noise, (at + 0.4 * drawn_m).yx / (0.31 * u_lace_m)).r;
  float fine = texture(u_noise, at / (0.11 * u_lace_m)).r;
  float broad = texture(u_noise, (at + drawn_m).yx / (2.7 * u_lace_m)).r;
  return mix(0.36 * wide + 0.32 * middle + 0.32 * fine, 1.0 - (0.14 * broad + 0.2 * wide + 0.3 * middle + 0.36 * fine), fresh);
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
vec3 foamLight(vec2 at, vec2 drawn_m, float lace, float fresh, vec3 normal, float sunlit_share, float blur) {
  vec2 toward_sun = u_sun_direction.xz * inversesqrt(dot(u_sun_direction.xz, u_sun_direction.xz) + 1e-4);
  float step_tiles = max(kReliefTiles, 0.7 * blur);
  float rise = laceAt(at + step_tiles * u_lace_m * toward_sun, drawn_m, fresh) - lace;
  float slope = clamp(kReliefSlope * rise * kReliefTiles / step_tiles, -kSteepest, kSteepest);
  vec3 bent = normalize(normal - slope * vec3(toward_sun.x, 0.0, toward_sun.y));
#ifdef HEAPED
  // Masses of it are billows, one upon the other.
  float heap = billowsAt(at);
  float billow = (billowsAt(at + kBillowStep * u_lace_m * toward_sun) - heap) * fresh;
  bent = normalize(bent - clamp(kBillowSlope * billow, -kSteepest, kSteepest) * vec3(toward_sun.x, 0.0, toward_sun.y));
#endif
  // Light that enters at one side of a lump leaves it at the others.
  float through = mix(0.2, 0.4, fresh);
  float sun = sunlit_share * clamp(mix(dot(bent, u_sun_direction), 1.0, through), 0.0, 1.0);
  // Little of the sky is seen from a crease.
  float open = mix(clamp(kOpen + kCreased * (lace - 0.5), 0.2, 1.05), 0.8, smoothstep(0.05, 0.3, blur));
#ifdef HEAPED
  // Much light passes through the heaps of fresh foam.
  open = mix(open, max(open * (0.75 + 0.4 * heap), 0.5), fresh);
#endif
  vec3 light = vec3(0.91, 0.95, 0.97) * open * (1.1 * u_sun_light * sun + u_ambient_up * vec3(0.97, 0.98, 0.98));
#ifdef HEAPED
  // In the valleys between billows there is more water than air.
  light = mix(light, u_bubbly * u_water_light, 0.85 * fresh * smoothstep(0.8, 0.2, heap) * smoothstep(0.75, 0.35, lace));
#endif
  return light;
}

// Water with `foam` on it, more than 0. `bubbles`: share of those below it that are drawn.
vec3 withFoam(vec3 water, vec2 at, float foam, float bubbles, vec3 normal, float sunlit_share) {
  // The water's motion draws the lace out and curls it.
  vec2 curl = vec2(texture(u_noise, at.yx / (2.9 * u_lace_m) + 0.13).r, texture(u_noise, at / (2.3 * u_lace_m) + 0.41).r);
  vec2 drawn_m = 0.2 * u_lace_m * (curl - 0.5);
  // Far away the lace is finer than a pixel, and its edges would be dots.
  vec2 at_step = fwidth(at);
  float blur = min(1.2 * max(at_step.x, at_step.y) / u_lace_m, 0.35);
  // Thinning foam comes apart in patches; fresh foam is one body.
  foam *= mix(0.5 + 0.9 * curl.y, 1.0, smoothstep(0.35, 0.9, foam));
  float cover = min(foam, 1.0);
  float fresh = heapedShare(cover);
  float lace = laceAt(at, drawn_m, fresh);
  // Near the camera its edges come apart in bubbles.
  float bubbly = 0.5 * (texture(u_noise, at.yx / (kBubbles * u_lace_m)).r + texture(u_noise, at / (0.37 * kBubbles * u_lace_m)).r) - 0.5;
  float torn = lace + kTornByBubbles * bubbly * (1.0 - smoothstep(0.0, kBubbles, 0.6 * blur));
  // How far the lace lies above the threshold is how thick the foam is: it becomes transparent toward its edges and holes, and as it fades.
  float thick = clamp((torn - 0.83 + 0.78 * cover + kFilled * fresh + 0.5 * blur) / (0.3 + 0.12 * cover + blur), 0.0, 1.0);
  float white = thick * thick * (3.0 - 2.0 * thick) * smoothstep(0.0, 0.3, foam) * mix(0.6, 0.97, cover);
  // Bubbles below the surface reach further than the froth on it.
  water = mix(water, u_bubbly * u_water_light, bubbles * 0.42 * cover * (0.35 + 0.65 * lace));
  return mix(water, foamLight(at, drawn_m, lace, fresh, normal, sunlit_share, blur), white);
}
