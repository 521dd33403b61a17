// Bakes the dome into one face of the cube: a clear day, thin cloud, a bright horizon.

in vec3 v_direction;
uniform vec3 u_sun_direction;
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
  vec3 zenith = vec3(0.035, 0.13, 0.38);
  vec3 middle = vec3(0.15, 0.36, 0.68);
  vec3 horizon = vec3(0.58, 0.72, 0.84);
  vec3 sky = mix(middle, zenith, smoothstep(0.12, 0.75, up));
  sky = mix(horizon, sky, smoothstep(-0.02, 0.20, up));
  sky += vec3(1.0, 0.75, 0.45) * (0.07 * pow(toward_sun, 5.0) + 0.28 * pow(toward_sun, 110.0));
  vec2 plane = direction.xz / (up + 0.16);
  float cover = cloud(plane * vec2(0.75, 1.05) + vec2(3.1, 1.7));
  cover = smoothstep(0.46, 0.80, cover) * smoothstep(0.02, 0.22, up);
  vec3 lit = mix(vec3(0.80, 0.85, 0.92), vec3(1.35, 1.22, 1.05), pow(toward_sun, 3.0));
  sky = mix(sky, lit, 0.75 * cover);
  vec3 ground = vec3(0.36, 0.37, 0.38);
  sky = mix(sky, ground, smoothstep(0.0, -0.08, direction.y));
  color = vec4(sky, 1.0);
}
