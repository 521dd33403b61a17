// Bakes the dome into one face of the cube, and in its alpha where stars shine through: the sky's colours, its glow around the sun, and clouds that cover a
// share of it (light/light.ts). PLAIN: and the far land, so that no picture has to.

in vec3 v_direction;
uniform vec3 u_sun_direction;  // also below the horizon
uniform vec3 u_moon_direction;
uniform vec3 u_zenith;
uniform vec3 u_middle;
uniform vec3 u_horizon;
uniform vec3 u_glow;
uniform vec3 u_halo;
uniform vec3 u_cloud;
uniform vec3 u_cloud_lit;
uniform float u_cloud_cover;
uniform vec3 u_ambient_up;
layout(location = 0) out vec4 color;

#include <cell_hash>
#ifdef PLAIN
#include <far_land>
uniform float u_lowest;  // -1: there is no horizon
#endif

float noise(vec2 p) {
  vec2 cell = floor(p), f = fract(p);
  vec2 w = f * f * (3.0 - 2.0 * f);
  float low = mix(cellHash(cell), cellHash(cell + vec2(1, 0)), w.x);
  float high = mix(cellHash(cell + vec2(0, 1)), cellHash(cell + vec2(1, 1)), w.x);
  return mix(low, high, w.y);
}

float cloud(vec2 p) {
  float sum = 0.0, weight = 0.45;
  for (int octave = 0; octave < 6; ++octave) {
    sum += weight * noise(p);
    p = mat2(1.6, 1.2, -1.2, 1.6) * p + 7.3;
    weight *= 0.56;
  }
  return sum;
}

void main() {
  vec3 direction = normalize(v_direction);
  vec3 ground = u_ambient_up * vec3(0.95, 0.79, 0.66);
  color = vec4(ground, 0.0);
  if (direction.y < -0.08) return;
  float up = max(direction.y, 0.0);
  float toward_sun = max(dot(direction, u_sun_direction), 0.0);
  vec3 sky = mix(u_middle, u_zenith, smoothstep(0.12, 0.75, up));
  // After sunset the horizon is bright on the sun's side only.
  float side = 0.5 + 0.5 * dot(direction, normalize(vec3(u_sun_direction.x, 0.0, u_sun_direction.z)));
  float low_sun = 1.0 - smoothstep(-0.05, 0.25, u_sun_direction.y);
  vec3 horizon = mix(u_horizon, u_middle, low_sun * 0.85 * (1.0 - side * side));
  sky = mix(horizon, sky, smoothstep(-0.02, 0.15, up));
  sky += u_glow * (0.07 * pow(toward_sun, 5.0) + 0.36 * pow(toward_sun, 70.0));
  float toward_moon = max(dot(direction, u_moon_direction), 0.0);
  sky += u_halo * (0.4 * pow(toward_moon, 8.0) + pow(toward_moon, 160.0));
  vec2 plane = direction.xz / (up + 0.09);
  vec2 at = plane * vec2(0.95, 1.25) + vec2(3.1, 1.7);
  at += 0.35 * vec2(noise(1.7 * at + 5.0), noise(1.7 * at + 23.0));
  float heavy = clamp((u_cloud_cover - 0.22) / 0.78, 0.0, 1.0);
  float least = 0.48 - 0.58 * heavy;
  float dense = cloud(at);
  // Light that comes through a heap: less through what lies between it and the sun. A closed layer shows its thickness.
  float through = 1.0;
  if (dense > least) {
    vec2 sunward = normalize(u_sun_direction.xz + vec2(1e-4));
    float passed = 0.0;
    for (int part = 1; part <= 3; ++part) passed += max(cloud(at + 0.09 * float(part) * sunward) - least, 0.0);
    through = exp(-2.6 * passed - 1.5 * (dense - least));
  }
  vec3 lit = mix(u_cloud, u_cloud_lit, min(through * (pow(toward_sun, 3.0) + 1.3 * (1.0 - heavy)), 1.0));
  lit *= mix(mix(0.62, 1.2, through), 0.45 + 1.1 * smoothstep(0.25, 0.75, dense), heavy);
  float cover = smoothstep(least, least + 0.1 + 0.38 * heavy, dense) * smoothstep(0.0, 0.06, up);
  // Thin high clouds between them.
  cover = max(cover, 0.35 * (1.0 - heavy) * smoothstep(0.4, 0.9, cloud(plane * vec2(0.2, 0.9) + 11.0)) * smoothstep(0.1, 0.4, up));
  cover *= mix(0.8, 0.95, heavy);
  // Air lies between the eye and the low ones.
  sky = mix(sky, mix(horizon, lit, mix(smoothstep(0.0, 0.1, up), 1.0, heavy)), cover);
  sky = mix(sky, ground, smoothstep(0.0, -0.08, direction.y));
#ifdef PLAIN
  if (u_lowest > -1.0) sky = withFarLand(sky, direction, 0.004);
#endif
  // Stars shine through where there are no clouds, and not through the haze at the horizon.
  color = vec4(sky, (1.0 - cover) * smoothstep(0.0, 0.22, direction.y));
}
