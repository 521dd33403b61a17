// The surface at points that somebody asks for, one invocation per point.
// Reads QUERY_POINTS [cells: column and row, whole numbers at the centres of cells], ELEVATION [cells, units], FLOW, BASIN, BED,
// FOAM_FIELD. Writes PARTIAL_SUM, SURFACE_POINT_TEXELS texels per point (shared/surface_points.h).
// Equations: elevation and velocity as in diagnostics/gauges.comp. Rate: d eta/dt = -div q. Slope: central differences at the four
// cells; behind a closed face, and in dry neighbours, the elevation continues level. Both are bilinear between wet cells, too.
// Depth: bilinear, dry cells count with 0. White water: bilinear between the cells of the foam.
// The four cells share what they read: each cell and each face is fetched once.
#include "shared/groups.h"
#include "shared/surface_points.h"
#include "diagnostics/wet_cells.glsl"
#if SURFACE_FOAM
#include "foam/foam_cell.glsl"
#endif

layout(local_size_x = PARTICLE_GROUP) in;

layout(std430, binding = QUERY_POINTS) restrict readonly buffer QueryPoints { vec2 query_points[]; };
layout(std430, binding = PARTIAL_SUM) restrict writeonly buffer SurfaceAtPoints { vec4 surface_at_point[]; };
uniform uint point_count;
#if SURFACE_FOAM
layout(binding = FOAM_FIELD) uniform samplerBuffer foam;

float whiteAt(vec2 place, ivec2 n) {
  const ivec2 cells = foamCounts(n);
  // The cells of the foam span the same water.
  const vec2 foam_place = (place + 0.5) * vec2(cells) / vec2(n) - 0.5;
  float white = 0.0;
  for (int each = 0; each < 4; ++each) {
    const Corner corner = cornerOf(foam_place, each, cells);
    white += corner.weight * whiteOf(texelFetch(foam, foamIndexOf(corner.cell, n)));
  }
  return white;
}
#endif

struct Column {
  int units;      // elevation
  float still_m;  // still depth
  bool wet;
};

Column columnAt(int x, int z, ivec2 n) {
  const int i = x + n.x * z;
  const int units = texelFetch(elevation, i).x;
  return Column(units, stillDepth(i), isWet(i, units));
}

/// Water over the bed. [m]
float depthOf(Column column) {
#if NONLINEAR
  return metresOf(heldUnits(column.units, column.still_m));
#else
  return max(column.still_m + metres(column.units), 0.0);
#endif
}

/// Elevation of a neighbour [units], or that of the cell if the surface does not continue there.
int levelAt(Column neighbour, Column here, float conductance_m) {
  return neighbour.wet && conductance_m > 0.0 ? neighbour.units : here.units;
}

/// Sums over the four cells.
struct Sums {
  vec4 motion;  // elevation, rate, velocity
  vec2 slope;
  float depth_m;
  float wet;
  float dry;
  float ground_m;
};

/// Adds a cell with the neighbours along x (left, right) and z (before, after); `corner` lies before it along both.
void add(inout Sums sums, float weight, Column here, Column left, Column right, Column before, Column after, Faces own,
         Faces from_left, Faces from_before, Faces from_corner) {
#if NONLINEAR
  sums.ground_m -= weight * here.still_m;
  const float gain = from_left.flow.z - own.flow.z + from_before.flow.w - own.flow.w;
  const vec4 open = vec4(1.0);
#else
  float gain = from_left.flow.x - own.flow.x + from_before.flow.y - own.flow.y;
#if STENCIL == 9
  gain += from_corner.flow.z - own.flow.z + from_before.flow.w - from_left.flow.w;
#endif
#if VARIED
  const vec4 open = vec4(own.conductance_m.xy, from_left.conductance_m.x, from_before.conductance_m.y);
#else
  const vec4 open = vec4(1.0);
#endif
#endif
  const vec2 rise_m =
      ELEVATION_UNIT_M * vec2(levelAt(right, here, open.x) - levelAt(left, here, open.z),
                              levelAt(after, here, open.y) - levelAt(before, here, open.w));
  const float wet = here.wet ? weight : 0.0;
  sums.motion += wet * vec4(metres(here.units), gain / sim.wave_cell_m, velocityOf(own, from_left, from_before));
  sums.slope += wet * (0.5 * rise_m / sim.wave_cell_m);
  sums.depth_m += wet * depthOf(here);
  sums.wet += wet;
  sums.dry += here.wet ? 0.0 : weight;
}

void main() {
  const uint k = gl_GlobalInvocationID.x;
  if (k >= point_count) return;
  const ivec2 n = waveCounts();
  vec2 place = query_points[k];
  const vec2 asked_place = place;
  // Beyond the centre of the outermost cell the water is as there.
#if !WAVE_PERIODIC_X
  place.x = clamp(place.x, 0.0, float(n.x - 1));
#endif
#if !WAVE_PERIODIC_Z
  place.y = clamp(place.y, 0.0, float(n.y - 1));
#endif
  const vec2 low = floor(place);
  const vec2 share = place - low;
  // The four cells are those of x.yz and z.yz. The faces before the outermost cell of a walled basin are the closed last ones.
  const ivec2 first = ivec2(wrapped(int(low.x), n.x), wrapped(int(low.y), n.y));
  const ivec4 x = ivec4(waveNeighbourX(first.x - 1, n.x), first.x, waveNeighbourX(first.x + 1, n.x), waveNeighbourX(first.x + 2, n.x));
  const ivec4 z = ivec4(waveNeighbourZ(first.y - 1, n.y), first.y, waveNeighbourZ(first.y + 1, n.y), waveNeighbourZ(first.y + 2, n.y));
  const ivec2 last = ivec2(wrapped(first.x - 1, n.x), wrapped(first.y - 1, n.y));

  const Column c_yx = columnAt(x.y, z.x, n), c_zx = columnAt(x.z, z.x, n);
  const Column c_xy = columnAt(x.x, z.y, n), c_yy = columnAt(x.y, z.y, n), c_zy = columnAt(x.z, z.y, n), c_wy = columnAt(x.w, z.y, n);
  const Column c_xz = columnAt(x.x, z.z, n), c_yz = columnAt(x.y, z.z, n), c_zz = columnAt(x.z, z.z, n), c_wz = columnAt(x.w, z.z, n);
  const Column c_yw = columnAt(x.y, z.w, n), c_zw = columnAt(x.z, z.w, n);
  const Faces f_yx = facesOf(ivec2(x.y, last.y), n), f_zx = facesOf(ivec2(x.z, last.y), n);
  const Faces f_xy = facesOf(ivec2(last.x, z.y), n), f_yy = facesOf(ivec2(x.y, z.y), n), f_zy = facesOf(ivec2(x.z, z.y), n);
  const Faces f_xz = facesOf(ivec2(last.x, z.z), n), f_yz = facesOf(ivec2(x.y, z.z), n), f_zz = facesOf(ivec2(x.z, z.z), n);
#if STENCIL == 9
  const Faces f_xx = facesOf(last, n);
#else
  const Faces f_xx = f_xy;  // not used
#endif

  Sums sums = Sums(vec4(0.0), vec2(0.0), 0.0, 0.0, 0.0, 0.0);
  add(sums, (1.0 - share.x) * (1.0 - share.y), c_yy, c_xy, c_zy, c_yx, c_yz, f_yy, f_xy, f_yx, f_xx);
  add(sums, share.x * (1.0 - share.y), c_zy, c_yy, c_wy, c_zx, c_zz, f_zy, f_yy, f_zx, f_yx);
  add(sums, (1.0 - share.x) * share.y, c_yz, c_xz, c_zz, c_yy, c_yw, f_yz, f_xz, f_yy, f_xy);
  add(sums, share.x * share.y, c_zz, c_yz, c_wz, c_zy, c_zw, f_zz, f_yz, f_zy, f_yy);
  if (sums.wet > 0.0) {
    sums.motion /= sums.wet;
    sums.slope /= sums.wet;
  } else {
    sums.motion.x = sums.ground_m;
  }
  surface_at_point[SURFACE_POINT_TEXELS * k] = sums.motion;
  surface_at_point[SURFACE_POINT_TEXELS * k + 1u] = vec4(sums.slope, sums.depth_m, sums.dry > 0.0 ? sums.wet : 1.0);
#if SURFACE_FOAM
  surface_at_point[SURFACE_POINT_TEXELS * k + 2u] = vec4(whiteAt(asked_place, n), vec3(0.0));
#else
  surface_at_point[SURFACE_POINT_TEXELS * k + 2u] = vec4(0.0);
#endif
}
