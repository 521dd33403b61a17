// One drop of rain on a repeating tile: a ring that grows and fades, then another elsewhere. Two triangles around it, and the same
// moved by a tile along x, along z and along both, so that a ring over the tile's edge continues at the opposite one.
in vec4 position;  // three random numbers of the drop; the number of its vertex: 6 of each of 4 copies

uniform float u_time_s;
uniform float u_tile_m;

out vec2 v_at_m;       // from the ring's centre
flat out float v_age;  // share of the ring's life

const float kReachM = 0.28;  // half a side of the quad; the largest ring is smaller
const vec2 kCorners[6] = vec2[6](vec2(-1.0), vec2(1.0, -1.0), vec2(1.0), vec2(-1.0), vec2(1.0), vec2(-1.0, 1.0));

float hash(float n) { return fract(sin(n) * 43758.5453); }

void main() {
  float life_s = 0.55 + 0.35 * position.z;
  float turns = u_time_s / life_s + position.x * 7.0;
  v_age = fract(turns);
  // Every fall has a position of its own.
  float fall = mod(floor(turns), 512.0);
  vec2 center = fract(position.xy + vec2(hash(fall + 17.0 * position.z), hash(fall + 31.0 * position.x)));
  int vertex = int(position.w);
  int copy = vertex / 6;
  center += vec2(float(copy & 1), float(copy >> 1)) * (vec2(1.0) - 2.0 * step(0.5, center));
  v_at_m = kReachM * kCorners[vertex % 6];
  gl_Position = vec4(2.0 * (center + v_at_m / u_tile_m) - 1.0, 0.0, 1.0);
}
