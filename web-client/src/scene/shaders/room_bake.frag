// Bakes a lit room into one face of the cube: a dark floor, walls of warm plaster, unlike water in hue, high windows on the sun's side, and lamps under the ceiling.

in vec3 v_direction;
uniform vec3 u_room_light;    // of walls, floor and ceiling, relative to noon
uniform vec3 u_window_light;  // seen through the windows, relative to noon
layout(location = 0) out vec4 color;

// Room of 2 by 1.3 by 2 around the eye, which is 0.45 above the floor.
const vec3 kHigh = vec3(1.0, 0.75, 1.0);
const vec3 kLow = vec3(-1.0, -0.55, -1.0);

// 1 inside a rectangle, with soft edges.
float within(vec2 at, vec2 low, vec2 high, float soft) {
  vec2 share = smoothstep(low - soft, low + soft, at) * (1.0 - smoothstep(high - soft, high + soft, at));
  return share.x * share.y;
}

void main() {
  vec3 direction = normalize(v_direction);
  vec3 safe = mix(vec3(1e-5), direction, step(vec3(1e-5), abs(direction)));
  vec3 t = max(kHigh / safe, kLow / safe);
  float way = min(t.x, min(t.y, t.z));
  vec3 at = direction * way;
  // Windows and lamps are what water and glass mirror: much brighter than the walls.
  vec3 light;
  if (way == t.y) {
    if (direction.y > 0.0) {
      vec2 lamp = abs(fract(at.xz * vec2(1.0, 1.5)) - 0.5);
      light = vec3(0.13, 0.115, 0.095) * u_room_light + vec3(3.4, 3.2, 2.8) * within(lamp, vec2(-1.0), vec2(0.17, 0.05), 0.02);
    } else {
      float plank = fract(at.z * 9.0);
      light = mix(vec3(0.050, 0.036, 0.026), vec3(0.066, 0.048, 0.034), smoothstep(0.0, 0.1, plank)) * u_room_light;
      // The window's light on the floor.
      light += vec3(0.10, 0.08, 0.055) * u_window_light * within(at.xz, vec2(-0.75, -0.85), vec2(0.25, -0.1), 0.25);
    }
  } else {
    float high = (at.y - kLow.y) / (kHigh.y - kLow.y);
    vec2 along = way == t.z ? vec2(at.x * sign(-direction.z), high) : vec2(at.z * sign(direction.x), high);
    // Lit from below the windows, darker toward the corners and the ceiling.
    float lit = (1.0 - 0.55 * along.x * along.x) * mix(1.0, 0.45, smoothstep(0.25, 0.75, high));
    light = mix(vec3(0.075, 0.055, 0.042), vec3(0.36, 0.27, 0.185), lit) * u_room_light;
    bool has_window = way == t.z ? direction.z < 0.0 : direction.x < 0.0;
    if (has_window) {
      vec2 pane = vec2(fract(along.x * 1.5 + 0.25), along.y);
      float open = within(pane, vec2(0.12, 0.64), vec2(0.88, 0.92), 0.012);
      vec3 sky = mix(vec3(0.95, 1.0, 1.05), vec3(0.55, 0.78, 1.1), smoothstep(0.6, 0.95, high)) * 1.25 * u_window_light;
      float frame = within(abs(pane - vec2(0.5, 0.78)), vec2(-1.0), vec2(0.012, 1.0), 0.006);
      light = mix(light, sky, open * (1.0 - frame));
    }
    // A dark skirting board.
    light *= mix(0.35, 1.0, smoothstep(0.05, 0.06, high));
  }
  color = vec4(light, 1.0);
}
