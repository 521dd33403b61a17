// Bakes the dark laboratory around a tank into one face of the cube: walls that lamps at their foot wash with light, rows of tubes overhead, and a
// row on each long wall. The tubes have sharp edges: mirrored in water and glass they show the shape of a surface.

in vec3 v_direction;
uniform vec3 u_room_light;  // relative to noon
layout(location = 0) out vec4 color;

// Half the room along x and z and its height, seen from a position on its floor.
const vec3 kRoom = vec3(2.0, 1.3, 1.5);
const vec3 kWall = vec3(0.006, 0.010, 0.016), kWash = vec3(0.020, 0.047, 0.082), kCeiling = vec3(0.004, 0.006, 0.009), kLamp = vec3(3.8, 4.2, 4.5);

float within(float at, float low, float high, float soft) { return smoothstep(low - soft, low + soft, at) * smoothstep(high + soft, high - soft, at); }

void main() {
  vec3 to = normalize(v_direction);
  // Polished, the floor mirrors the walls.
  vec3 up = vec3(to.x, abs(to.y), to.z);
  vec3 reach = kRoom / max(abs(up), vec3(1e-4));
  float away = min(reach.x, min(reach.y, reach.z));
  vec3 at = up * away;
  vec3 light = kCeiling;
  if (away == reach.y) {
    light += kLamp * within(abs(at.x), -1.0, 1.5, 0.02) * within(abs(fract(at.z / 0.36) - 0.5), -1.0, 0.12, 0.02);
  } else {
    bool is_long = away == reach.z;
    float along = is_long ? at.x : at.z;
    light = kWall + kWash * exp(-3.2 * at.y) * mix(0.25, 1.0, exp(-1.6 * along * along));
    if (is_long) light += 0.8 * kLamp * within(at.y, 0.80, 0.86, 0.006) * within(abs(fract(along / 0.7) - 0.5), -1.0, 0.42, 0.01) * within(abs(along), -1.0, 1.4, 0.01);
  }
  if (to.y < 0.0) light *= 0.25 + 0.75 * exp(-8.0 * up.y);
  color = vec4(light * u_room_light, 1.0);
}
