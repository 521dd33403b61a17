// The floor: warm stone outside, tiles under the water, with caustics (crests focus light, troughs spread it).
// PLAIN: without caustics.
#include <sky>

in vec3 v_world;
uniform vec3 u_camera_m;
uniform sampler2D u_field;
uniform float u_side_m;
uniform vec2 u_half_m;
uniform float u_depth_m;
uniform bool u_has_water;
layout(location = 0) out vec4 color;

#include <cell_hash>

// Brightness factor of slabs of `tile_m` with darker joints, about 1. Detail finer than a pixel fades to its mean, so that distant
// slabs neither flicker nor show as blocks.
float slabs(vec2 at, float tile_m, float uneven, float joint_dark) {
  vec2 cell = at / tile_m;
  vec2 step_cells = fwidth(cell);
  float blur = max(step_cells.x, step_cells.y);
  float fine = 1.0 - smoothstep(0.12, 0.45, blur);
  if (fine <= 0.0) return 1.0;
  vec2 edge = 0.5 - abs(fract(cell) - 0.5);
  float joint = 1.0 - smoothstep(0.011 - 0.5 * blur, 0.011 + blur, min(edge.x, edge.y));
  float seen = fine * min(0.05 / blur, 1.0);
  return 1.0 + fine * uneven * (cellHash(floor(cell)) - 0.5) - seen * joint_dark * joint;
}

void main() {
  vec2 at = v_world.xz;
  vec2 outside = max(abs(at) - u_half_m, 0.0);
  float away_m = length(outside);
  vec3 light = kSunColor * 0.85 * u_sun_direction.y + vec3(0.34, 0.42, 0.52);
  vec3 toward = v_world - u_camera_m;
  float distance_m = length(toward);
  vec3 lit;
  if (u_has_water && away_m <= 0.0) {
#ifndef PLAIN
    // Sunlight on this point crossed the surface further toward the sun and was refracted to a steeper path.
    vec2 crossed = at + u_sun_direction.xz / u_sun_direction.y * u_depth_m * 0.62;
    float curvature = texture(u_field, crossed / u_side_m + 0.5).a;
    float gathered = 1.0 / clamp(1.0 + 0.25 * u_depth_m * curvature, 0.35, 4.0);
    light *= mix(0.85, gathered, 0.75);
#endif
    lit = vec3(0.20, 0.43, 0.47) * slabs(at, u_side_m / 48.0, 0.14, 0.30) * light;
  } else {
    float shade = mix(0.50, 1.0, smoothstep(-0.2, 0.14 * u_side_m, away_m));
    lit = vec3(0.47, 0.395, 0.305) * shade * slabs(at, u_side_m / 12.0, 0.12, 0.26) * light;
  }
  // Haze begins behind the water, at any distance of the camera, and is complete before the disc ends: the horizon has the sky's colour.
  float clear_m = max(1.2 * u_side_m, length(u_camera_m));
  float far = max(distance_m - clear_m, 0.0) / (3.3 * clear_m);
  float haze = far * far / (1.0 + far * far);
  if (haze > 0.01) {
    haze += (1.0 - haze) * smoothstep(22.0, 38.0, distance_m / u_side_m);
    vec3 horizon = skyLight(normalize(vec3(toward.x, 0.02 * distance_m, toward.z)));
    lit = mix(lit, horizon, haze);
  }
  color = vec4(lit, 1.0);
}
