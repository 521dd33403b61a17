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
  float sum = 0.0, weight = 0.5;
  for (int octave = 0; octave < 6; ++octave) {
    sum += weight * noise(p);
    p = mat2(1.6, 1.2, -1.2, 1.6) * p + 7.3;
    weight *= 0.5;
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
  sky = mix(horizon, sky, smoothstep(-0.02, 0.20, up));
  sky += u_glow * (0.07 * pow(toward_sun, 5.0) + 0.36 * pow(toward_sun, 70.0));
  float toward_moon = max(dot(direction, u_moon_direction), 0.0);
  sky += u_halo * (0.4 * pow(toward_moon, 8.0) + pow(toward_moon, 160.0));
  vec2 plane = direction.xz / (up + 0.09);
  vec2 at = plane * vec2(0.55, 0.75) + vec2(3.1, 1.7);
  float dense = cloud(at);
  float heavy = clamp((u_cloud_cover - 0.22) / 0.78, 0.0, 1.0);
  // Heaps are bright where they are thinner toward the sun, and grey at their bases; a closed layer shows its thickness.
  vec2 sunward = normalize(u_sun_direction.xz + vec2(1e-4));
  float edge = clamp(0.5 + 2.6 * (dense - cloud(at + 0.16 * sunward)), 0.0, 1.0);
  vec3 lit = mix(u_cloud, u_cloud_lit, clamp(pow(toward_sun, 3.0) + 0.75 * edge * (1.0 - heavy), 0.0, 1.0));
  lit *= mix(mix(0.72, 1.12, edge), 0.45 + 1.1 * smoothstep(0.25, 0.75, dense), heavy);
  float cover = smoothstep(0.48 - 0.58 * heavy, 0.76 - 0.26 * heavy, dense) * smoothstep(0.0, 0.06, up);
  // Thin high clouds between them.
  cover = max(cover, 0.35 * (1.0 - heavy) * smoothstep(0.4, 0.9, cloud(plane * vec2(0.2, 0.9) + 11.0)) * smoothstep(0.1, 0.4, up));
  cover *= mix(0.8, 0.95, heavy);
  // Air lies between the eye and the low ones.
  sky = mix(sky, mix(horizon, lit, mix(smoothstep(0.0, 0.16, up), 1.0, heavy)), cover);
  sky = mix(sky, ground, smoothstep(0.0, -0.08, direction.y));
#ifdef PLAIN
  if (u_lowest > -1.0) sky = withFarLand(sky, direction, 0.004);
#endif
  // Stars shine through where there are no clouds, and not through the haze at the horizon.
  color = vec4(sky, (1.0 - cover) * smoothstep(0.0, 0.22, direction.y));
}
