// Bakes the hall around a tank into one face of the cube: walls with tall windows behind the water and at its sides, a dim ceiling with a soft box,
// and a floor. The walls are blue, as what level water mirrors outdoors is. Through water one sees the windows' bars bent, and mirrored light beside dark gives its surface a shape.

in vec3 v_direction;
uniform vec3 u_room_light;  // relative to noon
layout(location = 0) out vec4 color;

// Half the hall along x and z and its height, seen from a place on its floor.
const vec3 kHall = vec3(2.0, 1.05, 1.5);
const vec3 kWall = vec3(0.20, 0.29, 0.36), kCeiling = vec3(0.16, 0.18, 0.19), kFloor = vec3(0.20, 0.18, 0.16), kDay = vec3(1.20, 1.17, 1.10);
// Windows along a wall: distance, half width, sill and lintel; panes of a window along each side.
const float kApart = 0.82, kHalfWidth = 0.29, kSill = 0.12, kLintel = 0.84;
const vec2 kPanes = vec2(2.0, 4.0);

float within(float at, float low, float high, float soft) { return smoothstep(low - soft, low + soft, at) * smoothstep(high + soft, high - soft, at); }

// A wall at `along`, `high`: daylight in its windows.
vec3 wallLight(float along, float high) {
  float at = mod(along + 0.5 * kApart, kApart) - 0.5 * kApart;
  float is_window = within(at, -kHalfWidth, kHalfWidth, 0.012) * within(high, kSill, kLintel, 0.012);
  vec2 bar = 0.5 - abs(fract(vec2(at / (2.0 * kHalfWidth) + 0.5, (high - kSill) / (kLintel - kSill)) * kPanes) - 0.5);
  bar *= vec2(2.0 * kHalfWidth, kLintel - kSill) / kPanes;
  vec3 day = kDay * mix(0.75, 1.0, smoothstep(kSill, kLintel, high)) * mix(0.35, 1.0, smoothstep(0.003, 0.014, min(bar.x, bar.y)));
  return mix(kWall * mix(0.7, 1.15, smoothstep(0.0, 0.5, high)), day, is_window);
}

void main() {
  vec3 to = normalize(v_direction);
  // Polished, the floor mirrors the walls.
  vec3 up = vec3(to.x, abs(to.y), to.z);
  vec3 reach = kHall / max(abs(up), vec3(1e-4));
  float away = min(reach.x, min(reach.y, reach.z));
  vec3 at = up * away;
  vec3 light = kCeiling;
  if (away == reach.z) light = to.z < 0.0 ? wallLight(at.x, at.y) : 0.8 * kWall;
  else if (away == reach.x) light = wallLight(at.z, at.y);
  // Overhead, and toward the back.
  vec2 over = (up.xz + vec2(0.0, 0.25)) / max(up.y, 0.2);
  light += vec3(2.0, 2.5, 2.9) * smoothstep(0.75, 0.45, abs(over.x)) * smoothstep(0.55, 0.3, abs(over.y)) * smoothstep(0.45, 0.6, up.y);
  if (to.y < 0.0) light = mix(kFloor, light, 0.25 * exp(-6.0 * up.y));
  color = vec4(light * u_room_light, 1.0);
}
