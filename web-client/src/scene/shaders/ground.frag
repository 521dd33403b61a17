// The floor: pale stone outside, tiles under the water, lit through the surface (crests gather light, troughs spread it).
#include <sky>

in vec3 v_world;
uniform vec3 u_camera_m;
uniform sampler2D u_field;
uniform float u_side_m;
uniform float u_depth_m;
uniform bool u_has_water;
layout(location = 0) out vec4 color;

float joint(vec2 at, float tile_m, float joint_m) {
  vec2 inTile = abs(fract(at / tile_m) - 0.5) * tile_m;
  vec2 edge = 0.5 * tile_m - inTile;
  float blur = max(fwidth(at.x) + fwidth(at.y), 1e-4);
  float line = 1.0 - smoothstep(joint_m - blur, joint_m + blur, min(edge.x, edge.y));
  return line * clamp(joint_m * 6.0 / blur, 0.0, 1.0);
}

#include <cell_hash>

void main() {
  vec2 at = v_world.xz;
  vec2 outside = max(abs(at) - 0.5 * u_side_m, 0.0);
  float away_m = length(outside);
  vec3 light = kSunColor * 0.85 * u_sun_direction.y + vec3(0.34, 0.42, 0.52);
  vec3 stone = vec3(0.43, 0.39, 0.335) * (0.92 + 0.16 * cellHash(floor(at / 2.0)));
  stone *= 1.0 - 0.28 * joint(at, 2.0, 0.018);
  vec3 albedo = stone * mix(0.42, 1.0, smoothstep(-0.2, 0.22 * u_side_m, away_m));
  if (u_has_water && away_m <= 0.0) {
    vec3 tile = vec3(0.15, 0.34, 0.40) * (0.93 + 0.14 * cellHash(floor(at / 0.5)));
    albedo = tile * (1.0 - 0.30 * joint(at, 0.5, 0.012));
    // Sunlight reaching this point crossed the surface further along toward the sun, bent to a steeper path.
    vec2 crossed = at + u_sun_direction.xz / u_sun_direction.y * u_depth_m * 0.62;
    float curvature = texture(u_field, crossed / u_side_m + 0.5).a;
    float gathered = 1.0 / clamp(1.0 + 0.25 * u_depth_m * curvature, 0.35, 4.0);
    light *= mix(0.85, gathered, 0.75);
  }
  vec3 lit = albedo * light;
  vec3 toward = v_world - u_camera_m;
  float distance_m = length(toward);
  float far = distance_m / (11.0 * u_side_m);
  float haze = far * far / (1.0 + far * far);
  vec3 horizon = skyLight(normalize(vec3(toward.x, 0.035 * distance_m, toward.z)));
  color = vec4(mix(lit, horizon, haze), 1.0);
}
