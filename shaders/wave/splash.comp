// Splashes displace water. One invocation per cell of the tiles that splashes reach; it adds to the two faces that its
// cell owns what all of them move.
// Reads EventUniforms, SPLASH_TILES, BASIN, BED, ELEVATION. Adds to TRANSFER [nx x nz, units]; raises LIMIT_ARGS as
// wave/momentum.comp does.
// Invariant: nothing passes a closed face; the sum of whole units does not depend on the order of the splashes.
#include "shared/groups.h"
#include "wave/displacement.glsl"
#include "common/event_shapes.glsl"

layout(local_size_x = SPLASH_TILE, local_size_y = SPLASH_TILE) in;

layout(std430, binding = SPLASH_TILES) restrict readonly buffer SplashTiles { SplashTile splash_tiles[]; };

void main() {
  const uint tile = gl_WorkGroupID.x;
  const uint place = splash_tiles[tile].place;
  const ivec2 n = waveCounts();
  const ivec2 cell = SPLASH_TILE * ivec2(place & 0xfffu, place >> 12 & 0xfffu) + ivec2(gl_LocalInvocationID.xy);
  if (any(greaterThanEqual(cell, n))) return;
  const float cell_m = sim.wave_cell_m;
  const vec2 p = waveCellCentre(cell);
  const int i = cell.x + n.x * cell.y;
  const ivec2 next = nextCells(cell, n);
  const vec4 shares = effectShares(cell, next, n);
  const vec3 away_m = abs(vec3(metres(texelFetch(elevation, i).x), metres(texelFetch(elevation, next.x).x),
                               metres(texelFetch(elevation, next.y).x)));
  ivec2 moved = ivec2(0);
  // Each tile has a splash, and each word. (llvmpipe runs the body of a loop once more than its condition allows.)
  uint words = place >> 24;
  do {
    const int word = findLSB(words);
    uint left = splash_tiles[tile].splashes[word];
    do {
      const EventUniform e = splashes[32 * word + findLSB(left)];
      const float units = e.gain_m * ELEVATION_UNITS_PER_M / cell_m;
      const vec2 centre = vec2(e.x_m, e.z_m);
      const vec2 at_x = acrossSides(p + vec2(0.5 * cell_m, 0.0) - centre);
      const vec2 at_z = acrossSides(p + vec2(0.0, 0.5 * cell_m) - centre);
      vec2 displaced_m2 =
          passing(-vec2(splashDisplacement(at_x, e.radius_m).x, splashDisplacement(at_z, e.radius_m).y), shares);
      if (e.highest_m > 0.0) displaced_m2 *= strokeShares(away_m, e.highest_m);
      moved += ivec2(transferUnits(displaced_m2.x, units), transferUnits(displaced_m2.y, units));
      left &= left - 1u;
    } while (left != 0u);
    words &= words - 1u;
  } while (words != 0u);
  addTransfers(i, next, conductanceOf(cell, n), moved);
}
