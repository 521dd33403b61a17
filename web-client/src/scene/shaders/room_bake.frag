// Bakes a lit room into one face of the cube: a workshop with high windows on the sun's side, shelves on the other walls, wooden panels below,
// and lamps under the ceiling. Out of focus, as what is far behind a tank is.

in vec3 v_direction;
uniform vec3 u_room_light;    // of walls, floor and ceiling, relative to noon
uniform vec3 u_window_light;  // seen through the windows, relative to noon
layout(location = 0) out vec4 color;

#include <cell_hash>

// Room of 2 by 1.3 by 2 around the eye, which is 0.45 above the floor.
const vec3 kHigh = vec3(1.0, 0.75, 1.0);
const vec3 kLow = vec3(-1.0, -0.55, -1.0);
// Heights on a wall, as shares of it: top of the panels, of the window sill, and of the windows.
const float kPanels = 0.315;
const float kSill = 0.35;
const float kLintel = 0.86;
const float kSoft = 0.008;

// 1 inside a rectangle, with soft edges.
float within(vec2 at, vec2 low, vec2 high, float soft) {
  vec2 share = smoothstep(low - soft, low + soft, at) * (1.0 - smoothstep(high - soft, high + soft, at));
  return share.x * share.y;
}

// A garden under the sky.
vec3 outside(vec2 at) {
  float leaves = 0.11 * abs(sin(4.3 * at.x + 1.0)) + 0.05 * abs(sin(11.0 * at.x + 0.4)) + 0.02 * sin(31.0 * at.x);
  float tree = smoothstep(0.05, -0.05, at.y - 0.47 - leaves);
  vec3 sky = mix(vec3(1.05, 1.06, 1.04), vec3(0.62, 0.82, 1.08), smoothstep(0.5, 0.9, at.y));
  vec3 green = mix(vec3(0.30, 0.38, 0.14), vec3(0.13, 0.21, 0.10), smoothstep(0.36, 0.5, at.y)) * (0.75 + 1.8 * leaves);
  return mix(sky, green, tree) * u_window_light;
}

// Things that stand in a row: boxes, jars and books by the cell, of a hashed width, height and colour.
vec3 withThings(vec3 light, vec2 at, float foot, float cell_width, float most_high, float seed, vec3 lit) {
  float cell = floor(at.x / cell_width);
  vec4 dice = vec4(cellHash(vec2(cell, seed)), cellHash(vec2(cell, seed + 3.0)), cellHash(vec2(cell, seed + 7.0)), cellHash(vec2(cell, seed + 11.0)));
  float half_width = cell_width * (0.22 + 0.24 * dice.y);
  float high = most_high * (0.35 + 0.65 * dice.z);
  vec2 place = vec2(at.x - (cell + 0.5) * cell_width, at.y - foot);
  // Some are jars with a neck.
  if (dice.w > 0.7 && place.y > 0.6 * high) half_width *= 0.4;
  float seen = within(place, vec2(-half_width, 0.0), vec2(half_width, high), 0.5 * kSoft) * step(0.25, dice.x);
  vec3 paint = dice.w > 0.8 ? vec3(0.55, 0.16, 0.10) : dice.w > 0.55 ? vec3(0.10, 0.26, 0.30) : dice.w > 0.3 ? vec3(0.52, 0.40, 0.20) : vec3(0.42, 0.40, 0.36);
  // Lit from one side.
  return mix(light, paint * lit * (0.55 + 0.5 * smoothstep(-half_width, half_width, place.x)), seen);
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
      // The windows' light on the floor.
      vec2 pane = vec2(fract((at.x + 0.25 * at.z) * 1.5 + 0.25), at.z);
      light += vec3(0.30, 0.24, 0.16) * u_window_light * within(pane, vec2(0.16, -0.85), vec2(0.84, -0.15), 0.06);
    }
  } else {
    float high = (at.y - kLow.y) / (kHigh.y - kLow.y);
    vec2 along = way == t.z ? vec2(at.x * sign(-direction.z), high) : vec2(at.z * sign(direction.x), high);
    bool has_window = way == t.z ? direction.z < 0.0 : direction.x < 0.0;
    // Darker toward the corners and the ceiling.
    float lit = (1.0 - 0.45 * along.x * along.x) * mix(1.0, 0.5, smoothstep(0.3, 0.9, high));
    vec3 plaster = mix(vec3(0.10, 0.08, 0.062), has_window ? vec3(0.26, 0.215, 0.165) : vec3(0.44, 0.36, 0.27), lit);
    light = plaster * u_room_light;
    if (has_window) {
      float across = along.x * 1.5 + 0.25;
      vec2 pane = vec2(fract(across), high);
      float open = within(pane, vec2(0.10, kSill), vec2(0.90, kLintel), kSoft);
      float bar = max(within(abs(pane - vec2(0.5, 0.5)), vec2(-1.0), vec2(0.012, 1.0), kSoft), within(vec2(0.5, abs(high - 0.66)), vec2(-1.0), vec2(1.0, 0.006), kSoft));
      light = mix(light, mix(outside(vec2(along.x, high)), vec3(0.20, 0.19, 0.17) * u_room_light, bar), open);
      // The reveal, and the sill in the light.
      light *= 1.0 - 0.4 * within(pane, vec2(0.07, kSill), vec2(0.93, kLintel + 0.03), kSoft) * (1.0 - open);
      light = mix(light, vec3(0.85, 0.80, 0.70) * u_window_light, within(pane, vec2(0.05, kSill - 0.014), vec2(0.95, kSill), 0.5 * kSoft));
      // Against the light.
      light = withThings(light, vec2(along.x, high), kSill, 0.085, 0.13, floor(across), vec3(0.30) * u_room_light);
    } else {
      for (int board = 0; board < 3; ++board) {
        float foot = 0.40 + 0.15 * float(board);
        float shelf = within(vec2(along.x, high), vec2(-0.72, foot - 0.008), vec2(0.72, foot), 0.5 * kSoft);
        float shade = within(vec2(along.x, high), vec2(-0.72, foot - 0.05), vec2(0.72, foot - 0.008), 2.0 * kSoft);
        light *= 1.0 - 0.35 * shade;
        light = mix(light, vec3(0.30, 0.20, 0.12) * u_room_light, shelf);
        if (abs(along.x) < 0.7) light = withThings(light, vec2(along.x, high), foot, board == 1 ? 0.032 : 0.07, 0.115, 20.0 + float(board), 1.1 * u_room_light);
      }
    }
    // Wooden panels with a rail, and a dark skirting board.
    float joint = abs(fract(along.x * 6.0) - 0.5);
    vec3 panel = vec3(0.125, 0.083, 0.052) * (0.75 + 0.25 * smoothstep(0.42, 0.39, joint)) * (0.7 + 0.9 * high) * u_room_light;
    light = mix(panel, light, smoothstep(kPanels - kSoft, kPanels + kSoft, high));
    light = mix(light, vec3(0.26, 0.18, 0.115) * u_room_light, within(vec2(0.0, high), vec2(-1.0, kPanels - 0.012), vec2(1.0, kPanels + 0.004), 0.5 * kSoft));
    light *= mix(0.35, 1.0, smoothstep(0.05, 0.06, high));
  }
  color = vec4(light, 1.0);
}
