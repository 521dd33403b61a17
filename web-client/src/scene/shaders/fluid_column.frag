// Length of the sunlight's way through the liquid to a place on the floor [m].
#include <fluid_volume>

in vec2 v_uv;
uniform vec3 u_sun_direction;
uniform float u_floor_m;   // height of the floor
uniform float u_shaded_m;  // side of the square of floor that the target shows, around the origin
layout(location = 0) out float length_m;

const float kSteps = 32.0;

void main() {
  vec2 at = (v_uv - 0.5) * u_shaded_m;
  vec3 step_m = u_sun_direction / u_sun_direction.y * (u_cells_count.y * u_cell_m / kSteps);
  vec3 away_m = u_volume_min_m + u_cells_count * u_cell_m;
  length_m = 0.0;
  for (float i = 0.5; i < kSteps; ++i) {
    vec3 place = vec3(at.x, u_floor_m, at.y) + step_m * i;
    if (any(lessThan(place, u_volume_min_m)) || any(greaterThan(place, away_m))) continue;
    length_m += length(step_m) * smoothstep(0.6 * kSurface, 1.4 * kSurface, volumeAt(place).r);
  }
}
