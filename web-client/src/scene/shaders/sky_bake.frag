// Bakes the dome into one face of the cube, and in its alpha where stars shine through: the sky's colours, its glow around the sun, and clouds that cover a share of it (light/light.ts).

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
  float up = max(direction.y, 0.0);
  float toward_sun = max(dot(direction, u_sun_direction), 0.0);
  vec3 sky = mix(u_middle, u_zenith, smoothstep(0.12, 0.75, up));
  // After sunset the horizon is bright on the sun's side only.
  float side = 0.5 + 0.5 * dot(direction, normalize(vec3(u_sun_direction.x, 0.0, u_sun_direction.z)));
  float low_sun = 1.0 - smoothstep(-0.05, 0.25, u_sun_direction.y);
  vec3 horizon = mix(u_horizon, u_middle, low_sun * 0.85 * (1.0 - side * side));
  sky = mix(horizon, sky, smoothstep(-0.02, 0.20, up));
  sky += u_glow * (0.07 * pow(toward_sun, 5.0) + 0.28 * pow(toward_sun, 110.0));
  float toward_moon = max(dot(direction, u_moon_direction), 0.0);
  sky += u_halo * (0.4 * pow(toward_moon, 8.0) + pow(toward_moon, 160.0));
  vec2 plane = direction.xz / (up + 0.16);
  float cover = cloud(plane * vec2(0.75, 1.05) + vec2(3.1, 1.7));
  float heavy = clamp((u_cloud_cover - 0.22) / 0.78, 0.0, 1.0);
  vec3 lit = mix(u_cloud, u_cloud_lit, pow(toward_sun, 3.0));
  // A closed layer shows its thickness.
  lit *= mix(1.0, 0.45 + 1.1 * smoothstep(0.25, 0.75, cover), heavy);
  cover = smoothstep(0.46 - 0.56 * heavy, 0.80 - 0.30 * heavy, cover) * smoothstep(0.02, 0.22, up);
  cover *= mix(0.75, 0.95, heavy);
  sky = mix(sky, lit, cover);
  vec3 ground = u_ambient_up * vec3(0.95, 0.79, 0.66);
  sky = mix(sky, ground, smoothstep(0.0, -0.08, direction.y));
  // Stars shine through where there are no clouds, and not through the haze at the horizon.
  color = vec4(sky, (1.0 - cover) * smoothstep(0.0, 0.22, direction.y));
}
