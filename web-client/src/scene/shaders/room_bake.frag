// Bakes a lit room into one face of the cube: a hall with tall frosted windows on the sun's side, dark walls with upright lights, a polished floor,
// and rows of lamps under the ceiling. Out of focus, as what is far behind a tank is. Water and glass are seen by what they mirror and bend:
// bright areas beside dark ones.

in vec3 v_direction;
uniform vec3 u_room_light;    // of walls, floor and ceiling, relative to noon
uniform vec3 u_window_light;  // seen through the windows, relative to noon
layout(location = 0) out vec4 color;

// Room of 2 by 1.3 by 2 around the eye, which is 0.45 above the floor.
const vec3 kHigh = vec3(1.0, 0.75, 1.0);
const vec3 kLow = vec3(-1.0, -0.55, -1.0);
// Heights on a wall, as shares of it: of the window sill, and of the windows.
const float kSill = 0.21;
const float kLintel = 0.90;
const float kSoft = 0.010;
const vec3 kWall = vec3(0.075, 0.085, 0.098);

// 1 inside a rectangle, with soft edges.
float within(vec2 at, vec2 low, vec2 high, float soft) {
  vec2 share = smoothstep(low - soft, low + soft, at) * (1.0 - smoothstep(high - soft, high + soft, at));
  return share.x * share.y;
}

// A garden under the sky, far out of focus.
vec3 windowLight(vec2 along) {
  float leaves = 0.07 * sin(3.9 * along.x + 1.0) + 0.035 * sin(9.1 * along.x + 0.4);
  vec3 sky = mix(vec3(1.25, 1.25, 1.20), vec3(0.27, 0.53, 0.95), smoothstep(0.42, 0.88, along.y));
  vec3 green = mix(vec3(0.52, 0.56, 0.44), vec3(0.11, 0.20, 0.14), smoothstep(0.24, 0.42, along.y)) * (0.9 + 1.5 * leaves);
  vec3 light = mix(sky, green, smoothstep(0.14, -0.10, along.y - 0.43 - leaves));
  return light * mix(0.75, 1.5, exp(-1.6 * (along.x + 0.2) * (along.x + 0.2))) * u_window_light;
}

// A wall with windows between piers; below them a dark parapet.
vec3 windowWall(vec2 along, float soft) {
  float across = fract(along.x * 2.0 + 0.25);
  float open = within(vec2(across, along.y), vec2(0.07, kSill), vec2(0.93, kLintel), soft);
  float bar = within(vec2(abs(across - 0.5), along.y), vec2(-1.0, 0.0), vec2(0.018, 1.0), soft);
  bar = max(bar, within(vec2(0.5, abs(along.y - 0.62)), vec2(-1.0), vec2(1.0, 0.007), soft));
  vec3 wall = kWall * u_room_light * mix(0.6, 1.3, along.y);
  vec3 light = mix(wall, mix(windowLight(along), wall, bar), open);
  // Its light on the sill.
  return mix(light, vec3(0.55, 0.55, 0.54) * u_window_light, within(vec2(across, along.y), vec2(0.05, kSill - 0.016), vec2(0.95, kSill), 0.6 * soft));
}

void main() {
  vec3 direction = normalize(v_direction);
  vec3 safe = mix(vec3(1e-5), direction, step(vec3(1e-5), abs(direction)));
  vec3 t = max(kHigh / safe, kLow / safe);
  float way = min(t.x, min(t.y, t.z));
  vec3 at = direction * way;
  vec3 light;
  if (way == t.y) {
    if (direction.y > 0.0) {
      vec2 lamp = abs(fract(at.xz * vec2(1.0, 1.5)) - 0.5);
      light = kWall * u_room_light + vec3(3.2, 3.1, 2.9) * within(lamp, vec2(-1.0), vec2(0.30, 0.05), 0.02);
    } else {
      // Polished: the windows are mirrored, the more the flatter one looks.
      light = vec3(0.060, 0.062, 0.066) * u_room_light;
      vec3 mirrored = vec3(direction.x, -direction.y, direction.z);
      float past = 1.0 - abs(direction.y);
      vec3 wall_t = max(kHigh / mix(vec3(1e-5), mirrored, step(vec3(1e-5), abs(mirrored))), kLow / mix(vec3(1e-5), mirrored, step(vec3(1e-5), abs(mirrored))));
      bool is_back = wall_t.z < wall_t.x;
      if (is_back ? direction.z < 0.0 : direction.x < 0.0) {
        vec3 hit = at + mirrored * min(((mirrored.x > 0.0 ? 1.0 : -1.0) - at.x) / mirrored.x, ((mirrored.z > 0.0 ? 1.0 : -1.0) - at.z) / mirrored.z);
        vec2 along = is_back ? vec2(hit.x, (hit.y - kLow.y) / 1.3) : vec2(-hit.z, (hit.y - kLow.y) / 1.3);
        light += windowWall(along, 0.05) * (0.06 + 0.5 * past * past * past);
      }
    }
  } else {
    float high = (at.y - kLow.y) / (kHigh.y - kLow.y);
    vec2 along = way == t.z ? vec2(at.x * sign(-direction.z), high) : vec2(at.z * sign(direction.x), high);
    bool has_window = way == t.z ? direction.z < 0.0 : direction.x < 0.0;
    if (has_window) light = windowWall(along, kSoft);
    else {
      light = kWall * u_room_light * (1.0 - 0.4 * along.x * along.x) * mix(0.55, 1.5, high);
      // Upright lights in the wall.
      light += vec3(0.7, 0.68, 0.64) * u_room_light * within(vec2(abs(along.x), high), vec2(0.44, 0.34), vec2(0.52, 0.9), kSoft);
    }
    // A dark skirting board.
    light *= mix(0.4, 1.0, smoothstep(0.05, 0.06, high));
  }
  color = vec4(light, 1.0);
}
