// Bakes a lit room into one face of the cube: a wooden floor, light walls, a window on the sun's side, and lamps under the ceiling.

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
  vec3 wall = vec3(0.60, 0.54, 0.44);
  vec3 light;
  if (way == t.y) {
    if (direction.y > 0.0) {
      light = vec3(0.55, 0.55, 0.53) * u_room_light;
      vec2 lamp = abs(fract(at.xz * vec2(1.0, 1.5)) - 0.5);
      light += vec3(2.6, 2.5, 2.3) * within(lamp, vec2(-1.0), vec2(0.17, 0.05), 0.02);
    } else {
      float plank = fract(at.z * 9.0);
      light = mix(vec3(0.17, 0.115, 0.075), vec3(0.20, 0.14, 0.095), smoothstep(0.0, 0.1, plank)) * u_room_light;
      // The window's light on the floor.
      light += vec3(0.20, 0.19, 0.16) * u_window_light * within(at.xz, vec2(-0.75, -0.85), vec2(0.25, -0.1), 0.25);
    }
  } else {
    float high = (at.y - kLow.y) / (kHigh.y - kLow.y);
    light = wall * mix(0.62, 1.08, smoothstep(0.0, 1.0, high));
    float lateral = way == t.z ? at.x : at.z;
    // Wooden panels below, with a rail.
    float panel = within(vec2(fract(lateral * 5.0), high), vec2(0.10, 0.05), vec2(0.90, 0.26), 0.012);
    vec3 wood = mix(vec3(0.15, 0.085, 0.05), vec3(0.20, 0.12, 0.07), panel);
    light = mix(mix(wood, vec3(0.26, 0.16, 0.10), smoothstep(0.285, 0.295, high)), light, smoothstep(0.31, 0.32, high));
    light *= u_room_light;
    vec2 along = way == t.z ? vec2(at.x * sign(-direction.z), high) : vec2(at.z * sign(direction.x), high);
    bool has_window = way == t.z ? direction.z < 0.0 : direction.x < 0.0;
    if (has_window) {
      vec2 pane = vec2(fract(along.x * 1.5 + 0.25), along.y);
      float open = within(pane, vec2(0.12, 0.36), vec2(0.88, 0.88), 0.012);
      vec3 sky = mix(vec3(0.95, 1.0, 1.05), vec3(0.55, 0.78, 1.1), smoothstep(0.4, 0.9, high)) * 1.5;
      sky = mix(vec3(0.30, 0.40, 0.22), sky, smoothstep(0.42, 0.50, high));
      float frame = within(abs(pane - vec2(0.5, 0.62)), vec2(-1.0), vec2(0.012, 1.0), 0.006);
      sky *= u_window_light;
      light = mix(light, sky, open * (1.0 - frame));
      light += vec3(0.10, 0.10, 0.09) * u_window_light * within(pane, vec2(0.02, 0.26), vec2(0.98, 0.98), 0.12) * (1.0 - open);
    }
    light *= mix(0.55, 1.0, smoothstep(0.0, 0.035, high));
  }
  // Darker than what stands in it, so that water and glass are what is seen.
  color = vec4(light * 0.38, 1.0);
}
