// Length of the sunlight's way through the liquid to a place on the floor [m].
#include <fluid_volume>

in vec2 v_uv;
uniform vec3 u_sun_direction;
uniform float u_floor_m;   // height of the floor
uniform float u_shaded_m;  // side of the square of floor that the target shows, around the origin
layout(location = 0) out float length_m;

const float kSteps = 24.0;

void main() {
  vec3 from = vec3((v_uv - 0.5) * u_shaded_m, 0.0).xzy;
  from.y = u_floor_m + 1e-3;
  vec3 safe = mix(vec3(1e-6), u_sun_direction, step(vec3(1e-6), abs(u_sun_direction)));
  vec3 a = (u_volume_min_m - from) / safe, b = (u_volume_max_m - from) / safe;
  vec3 near = min(a, b), far = max(a, b);
  float enters_m = max(max(near.x, near.z), 0.0), leaves_m = min(min(far.x, far.z), far.y);
  float step_m = (leaves_m - enters_m) / kSteps;
  length_m = 0.0;
  if (step_m <= 0.0) return;
  for (float i = 0.5; i < kSteps; ++i) length_m += step_m * smoothstep(0.5 * kSurface, 1.5 * kSurface, volumeAt(from + u_sun_direction * (enters_m + i * step_m)).r);
}
