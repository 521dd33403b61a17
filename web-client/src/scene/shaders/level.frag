// The elevation → the level of the water, continued over dry ground: there the streamed elevation is that of the ground, which would bend
// the surface upward at a waterline and over rocks. Where the level falls below the ground, between two texels, is the waterline.
// PLAIN: only one texel far; field.frag reads two, so that the surface bends a little before its edge.
// Reads u_elevation and writes the level, in units of u_unit_m; u_cells: ground with obstacles and without them [m].

uniform isampler2D u_elevation;
uniform sampler2D u_cells;
uniform float u_unit_m;
uniform float u_film_m;  // thinner water counts as none

// Water that runs up an obstacle and is thinner than this counts as none: drawn, it would be a dome of glass round a rock.
const float kObstacleFilmM = 0.2;

#ifdef PLAIN
const int kReach = 1;
#else
const int kReach = 3;
#endif

layout(location = 0) out int level;

// `ground_m`: height of the ground with obstacles, and without them.
bool isObstacle(vec2 ground_m) { return ground_m.r - ground_m.g > 0.01; }
float filmOf(vec2 ground_m) { return isObstacle(ground_m) ? kObstacleFilmM : u_film_m; }

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  ivec2 last = textureSize(u_elevation, 0) - 1;
  int here = texelFetch(u_elevation, at, 0).r;
  vec2 ground_m = texelFetch(u_cells, at, 0).rg;
  if (float(here) * u_unit_m - ground_m.r > filmOf(ground_m)) {
    level = here;
    return;
  }
  // The mean level and depth of the water near, by the inverse of the distance squared.
  vec3 near = vec3(0.0);
  for (int z = -kReach; z <= kReach; ++z)
    for (int x = -kReach; x <= kReach; ++x) {
      ivec2 beside = clamp(at + ivec2(x, z), ivec2(0), last);
      float high_m = float(texelFetch(u_elevation, beside, 0).r) * u_unit_m;
      vec2 beside_m = texelFetch(u_cells, beside, 0).rg;
      float deep_m = high_m - beside_m.r;
      if (deep_m > filmOf(beside_m)) near += vec3(high_m, deep_m, 1.0) / float(x * x + z * z);
    }
  float level_m = ground_m.g - 0.02;
  if (near.z > 0.0) {
    near.xy /= near.z;
    // Beside an obstacle the water continues into it. Elsewhere it ends before this texel: halfway for water that runs downhill.
    level_m = isObstacle(ground_m) ? near.x : min(near.x, ground_m.g - 0.5 * near.y);
  }
  level = int(round(level_m / u_unit_m));
}
