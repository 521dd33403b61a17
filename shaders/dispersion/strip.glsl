// Sweeps over the faces of one grid of the dispersion's V-cycle (sim_setup/dispersion.h). A texel holds the x face and the z
// face of a cell, two poles each: (x_0, x_1, z_0, z_1). Closed faces hold 0, so that indices may wrap
// around every side.
//   K phi = m phi - grad(e div phi), with differences between cells as grad and div; except if FINEST, for the faces along an axis
//           - grad(e div phi - f D phi), where D takes the difference across a cell along that axis alone
//   sweep: phi += w (r - K phi), w = DISPERSION_SWEEP_WEIGHT over the diagonal of K
// An invocation owns DISPERSION_COLUMNS columns of DISPERSION_STRIP rows and passes over them row by row. It does several
// sweeps at once, each a row behind the one before it, and computes the neighbours that they need itself: that costs less
// than fetching them.
// FINEST: 1 for the grid of the wave, whose right side r is the slope of the surface.
// NONLINEAR: wave/shallow_slope.comp has computed that slope; elsewhere it follows from ELEVATION and PRESSURE_HEAD.
// FLAT: 1 if there are no obstacles or beaches and no grid has cells beyond the water: m, e and c are the same in all cells,
// and only faces at sides are closed. In other basins DISPERSION_STRIPS lists the strips of a dispatch.
// STEADY: 1 if flat, and for strips in which m, e and c are the same in all rows and no wall is near.
// NARROW: 1 if a grid has so few cells along an axis that the neighbours of a strip go around it more than once.
#ifndef SPINDRIFT_DISPERSION_STRIP
#define SPINDRIFT_DISPERSION_STRIP

#include "shared/bindings.h"
#include "shared/dispersion_uniforms.h"
#include "shared/groups.h"
#include "wave/wave_cell.glsl"


// Tables of sim_setup/dispersion.h: m_x, m_z, e_0, e_1 of a cell, times the scene's depth. Then on the finest grid the square
// roots of c_j times that depth at its faces, x face first, on the others f_0, f_1 of the cell, along x and along z.
#if FLAT
layout(binding = DISPERSION_COEFFICIENTS) uniform samplerBuffer coefficients;
#else
// Two halves in each number.
layout(binding = DISPERSION_COEFFICIENTS) uniform usamplerBuffer coefficients;
// Numbers of the strip along x (15 bits), DISPERSION_SIDES_WITHOUT_SPREAD and along z (16 bits); padding lies outside the grid.
layout(binding = DISPERSION_STRIPS) uniform usamplerBuffer strips;
#endif

#if FINEST && NONLINEAR
layout(binding = SURFACE_RISE) uniform samplerBuffer surface_rise;
#elif FINEST
layout(binding = ELEVATION) uniform isamplerBuffer elevation;
#if HEAD
layout(binding = PRESSURE_HEAD) uniform isamplerBuffer pressure_head;
#endif
#else
layout(binding = DISPERSION_RIGHT) uniform samplerBuffer right_side;
#endif

#if !STEADY
// Weights of the x face and the z face in the faces E, W, N, S of the coarser grid, two halves in each number.
layout(binding = DISPERSION_WEIGHTS) uniform usamplerBuffer weights;
#endif

/// Columns of a row that an invocation computes with: its own and three on each side, one for each sweep.
#define WIDTH (DISPERSION_COLUMNS + 6)

/// A row of cells: the right side and the coefficients of K.
struct Row {
  vec4 right[WIDTH];
#if STEADY
  float open_z;  // 0 where the z faces are at a closed side
  float spread_share;
#else
  vec4 weight[WIDTH];
  vec4 stiff[WIDTH];
#if !FINEST
  vec4 spread[WIDTH];
#endif
#endif
};

/// e div phi of a cell, for both poles; on coarse grids less f D phi, for the faces along x and along z.
#if FINEST
#define Pressed vec2
#define alongX(p) (p)
#define alongZ(p) (p)
#else
#define Pressed vec4
#define alongX(p) ((p).xy)
#define alongZ(p) ((p).zw)
#endif

/// The last row that a sweep has taken: its faces before the sweep, and what its cells press with.
struct Swept {
  vec4 faces[WIDTH];
  Pressed pressed[WIDTH];
};

// Cells of this grid and of the next coarser one; an axis that cannot be halved has one more row, of dry cells.
ivec2 counts;         // of this grid
int column[WIDTH];    // x of the columns
#if STEADY
vec4 steady_stiffness[WIDTH];
vec4 steady_weight[WIDTH];  // 0 where the x face is closed
vec4 steady_rest[WIDTH];    // root_c on the finest grid, elsewhere the spread
float side_spread;          // 0 if cells at sides across z have no spread
#else
uvec4 coefficients_ahead[WIDTH + 1];  // of the next row
#endif
/// Like wrapped(), also where a strip is wider than the grid: i >= -8 n. (% of negative numbers is undefined.)
int around(int i, int n) {
#if NARROW
  return (i + 8 * n) % n;
#else
  return wrapped(i, n);
#endif
}

#if FINEST
ivec2 wave_counts;
// Columns of the wave: those of the grid; in place of dry cells beyond the water, the last one.
int level_column[WIDTH + 1];
#endif
#if FINEST && NONLINEAR
vec2 rise_ahead[WIDTH];  // of the next row [units]
#elif FINEST
int level_ahead[WIDTH + 1];  // of the next row [units]

int levelAt(int i) {
#if HEAD
  return texelFetch(elevation, i).x + texelFetch(pressure_head, i).x;
#else
  return texelFetch(elevation, i).x;
#endif
}
#endif

/// Two halves, without infinities: the same bits as a float, 112 exponents lower. (unpackHalf2x16 is slow on llvmpipe.)
vec2 unpacked(uint word) {
  const uvec2 bits = uvec2(word << 16u, word);
  return uintBitsToFloat((bits & 0x80000000u) | ((bits >> 3u) & 0x0fffe000u)) * 5.1922968585348276e33;
}

vec4 halves(uvec2 words) { return vec4(unpacked(words.x), unpacked(words.y)); }

vec4 stiffnessOf(Row row, int c) {
#if STEADY
  return steady_stiffness[c];
#else
  return row.stiff[c];
#endif
}

/// DISPERSION_SWEEP_WEIGHT over the diagonal of K; 0 where closed.
vec4 weightOf(Row row, int c) {
#if STEADY
  return steady_weight[c] * vec4(1.0, 1.0, row.open_z, row.open_z);
#else
  return row.weight[c];
#endif
}

#if !FINEST
vec4 spreadOf(Row row, int c) {
#if STEADY
  return steady_rest[c] * row.spread_share;
#else
  return row.spread[c];
#endif
}
#endif

#if !FLAT
/// Of faces of a cell with the given stiffness, e_0 and e_1 of the cells behind them.
vec4 weightFor(vec4 stiff, vec2 beyond_x, vec2 beyond_z) {
  const vec4 diagonal = stiff.xxyy + stiff.zwzw + vec4(beyond_x, beyond_z);
  return mix(vec4(0.0), DISPERSION_SWEEP_WEIGHT / diagonal, greaterThan(stiff.xxyy, vec4(0.0)));
}
#endif

/// Fetches what is needed of row z before fetchRow(z).
void fetchAhead(int z) {
#if FINEST
  const int level_row = wave_counts.x * min(z, wave_counts.y - 1);
#if NONLINEAR
  for (int c = 0; c < WIDTH; ++c) rise_ahead[c] = texelFetch(surface_rise, level_column[c] + level_row).xy;
#else
  for (int c = 0; c <= WIDTH; ++c) level_ahead[c] = levelAt(level_column[c] + level_row);
#endif
#endif
#if !STEADY
  const int row = counts.x * z;
  const int beyond = wrapped(column[WIDTH - 1] + 1, counts.x);
  for (int c = 0; c < WIDTH; ++c) coefficients_ahead[c] = texelFetch(coefficients, column[c] + row);
  coefficients_ahead[WIDTH] = texelFetch(coefficients, beyond + row);
#endif
}

/// Column and row of the first cell of the invocation's strip; outside the grid if it has none. Sets the counts.
ivec2 firstCell(ivec2 invocation) {
  counts = ivec2(int(grid_nx), int(grid_nz));
#if FLAT
  const ivec2 strip = invocation;
#else
  const uint word = texelFetch(strips, invocation.x).x;
  const ivec2 strip = ivec2(int(word & (DISPERSION_SIDES_WITHOUT_SPREAD - 1u)), int(word >> 16u));
#if STEADY
  side_spread = (word & DISPERSION_SIDES_WITHOUT_SPREAD) == 0u ? 1.0 : 0.0;
#endif
#endif
  return strip * ivec2(DISPERSION_COLUMNS, DISPERSION_STRIP);
}

/// Sets the columns, the first of which may be outside, and fetches what the first row needs. `inner_row`: the second one of the strip.
void begin(int first_column, int first_row, int inner_row) {
  for (int c = 0; c < WIDTH; ++c) column[c] = around(first_column + c, counts.x);
#if FINEST
  wave_counts = waveCounts();
  for (int c = 0; c < WIDTH; ++c) level_column[c] = min(column[c], wave_counts.x - 1);
  level_column[WIDTH] = min(wrapped(column[WIDTH - 1] + 1, counts.x), wave_counts.x - 1);
#endif
#if FLAT
  const vec4 stiff = texelFetch(coefficients, 0);
  const vec4 rest = texelFetch(coefficients, 1);
  for (int c = 0; c < WIDTH; ++c) {
    steady_stiffness[c] = stiff;
    steady_rest[c] = rest;
    steady_weight[c] = DISPERSION_SWEEP_WEIGHT / (stiff.xxyy + 2.0 * stiff.zwzw);
#if !WAVE_PERIODIC_X
    if (column[c] == counts.x - 1) steady_weight[c].xy = vec2(0.0);
#endif
  }
#elif STEADY
  uvec4 words[WIDTH + 1];
  for (int c = 0; c < WIDTH; ++c) words[c] = texelFetch(coefficients, column[c] + counts.x * inner_row);
  words[WIDTH] = texelFetch(coefficients, wrapped(column[WIDTH - 1] + 1, counts.x) + counts.x * inner_row);
  for (int c = 0; c < WIDTH; ++c) {
    const vec4 stiff = halves(words[c].xy);
    steady_stiffness[c] = stiff;
    steady_rest[c] = halves(words[c].zw);
    steady_weight[c] = weightFor(stiff, unpacked(words[c + 1].y), stiff.zw);
  }
#endif
  fetchAhead(around(first_row, counts.y));
}

/// The row z, inside the grid; rows are fetched in order.
Row fetchRow(int z) {
  Row row;
  const int first = counts.x * z;
#if FINEST && NONLINEAR
  const vec2 rise[WIDTH] = rise_ahead;
#elif FINEST
  int level[WIDTH + 1] = level_ahead;
#endif
#if STEADY
#if WAVE_PERIODIC_Z
  row.open_z = 1.0;
#else
  row.open_z = z == counts.y - 1 ? 0.0 : 1.0;
#endif
#if FLAT || WAVE_PERIODIC_Z
  row.spread_share = 1.0;
#else
  row.spread_share = z == 0 || z == counts.y - 1 ? side_spread : 1.0;
#endif
#else
  uvec4 here[WIDTH + 1] = coefficients_ahead;
#endif
  fetchAhead(wrapped(z + 1, counts.y));
  for (int c = 0; c < WIDTH; ++c) {
#if FINEST
#if NONLINEAR
    const vec2 slope = rise[c];
#else
    const vec2 slope = vec2(level[c + 1] - level[c], level_ahead[c] - level[c]);
#endif
#if STEADY
    row.right[c] = steady_rest[c] * slope.xxyy;
#else
    row.right[c] = halves(here[c].zw) * slope.xxyy;
#endif
#else
    row.right[c] = texelFetch(right_side, column[c] + first);
#endif
#if !STEADY
    const vec4 stiff = halves(here[c].xy);
    row.weight[c] = weightFor(stiff, unpacked(here[c + 1].y), unpacked(coefficients_ahead[c].y));
    row.stiff[c] = stiff;
#if !FINEST
    row.spread[c] = halves(here[c].zw);
#endif
#endif
  }
  return row;
}

/// Weights of the faces of a cell in the four faces E, W, N, S of its block of the next coarser grid. A coarse flux passes the
/// open part of its face evenly; inside the block it goes where every cell gains the same height, without obstacles half each
/// to both inner faces of its axis.
struct Weights {
  vec4 x;
  vec4 z;
};

Weights weightsAt(int c, bool is_odd_x, int z) {
#if !STEADY
  const uvec4 words = texelFetch(weights, column[c] + counts.x * z);
  return Weights(halves(words.xy), halves(words.zw));
#else
  return Weights(is_odd_x ? vec4(1.0, 0.0, 0.0, 0.0) : vec4(0.5, 0.5, 0.0, 0.0),
                 z % 2 == 1 ? vec4(0.0, 0.0, 1.0, 0.0) : vec4(0.0, 0.0, 0.5, 0.5));
#endif
}

/// First sweep from zero.
void start(Row row, out vec4 faces[WIDTH]) {
  for (int c = 0; c < WIDTH; ++c) faces[c] = weightOf(row, c) * row.right[c];
}

/// What the faces of the last row have left, r - K phi, in columns margin + 1 to WIDTH - margin - 2; takes the faces of the
/// row after it, known in columns margin to WIDTH - margin - 1, as the last row.
void takeRow(int margin, inout Swept last, Row last_row, Row row, vec4 faces[WIDTH], out vec4 left[WIDTH]) {
  Pressed pressed[WIDTH];
  for (int c = margin + 1; c < WIDTH - margin; ++c) {
#if FINEST
    pressed[c] = stiffnessOf(row, c).zw * (faces[c].xy - faces[c - 1].xy + faces[c].zw - last.faces[c].zw);
#else
    const vec4 across = faces[c] - vec4(faces[c - 1].xy, last.faces[c].zw);
    pressed[c] = (stiffnessOf(row, c).zw * (across.xy + across.zw)).xyxy - spreadOf(row, c) * across;
#endif
  }
  for (int c = margin + 1; c < WIDTH - margin - 1; ++c)
    left[c] = last_row.right[c] - stiffnessOf(last_row, c).xxyy * last.faces[c] +
              vec4(alongX(last.pressed[c + 1] - last.pressed[c]), alongZ(pressed[c] - last.pressed[c]));
  last.faces = faces;
  last.pressed = pressed;
}

/// The same, and sweeps the last row.
void sweepRow(int margin, inout Swept last, Row last_row, Row row, vec4 faces[WIDTH], out vec4 swept[WIDTH]) {
  const vec4 before[WIDTH] = last.faces;
  vec4 left[WIDTH];
  takeRow(margin, last, last_row, row, faces, left);
  for (int c = margin + 1; c < WIDTH - margin - 1; ++c) swept[c] = before[c] + weightOf(last_row, c) * left[c];
}

#endif
