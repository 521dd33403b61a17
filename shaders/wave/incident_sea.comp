// The sea that comes in from outside, in the layers of absorbing sides.
// Reads SeaUniforms, SEA_BLOCKS, SEA_COLUMNS, SEA_ROWS, BASIN, BED. Writes INCIDENT_SEA [nx x nz: part of x in the
// elevation, flow toward +x and +z, part of z in the elevation; units and m^2/s] in a share of the blocks of those layers; each block is valid for several steps.
// Equation: the sum of A cos(kx x + kz z - omega t + phase) over the plane waves of the sea (docs/wind_sea.md), as the real
// part of strength(t) * column(x) * row(z). A strip of rows is summed at a time: its first row is read, and each
// further row is one rotation.
// The faces at the edge of the water are closed. What the sea would move through them is added to the elevation that a cell at
// the edge relaxes to, so that it enters the cell: inflow/(sigma dx), in the part of the face's axis.
// Invariant: closed faces carry nothing, and nothing comes in over a bed that rises.
#include "shared/groups.h"
#include "shared/sea_uniforms.h"
#include "shared/side_bits.h"
#include "wave/water_column.glsl"

layout(local_size_x = SEA_BLOCK, local_size_y = SEA_GROUP_BLOCKS) in;

layout(binding = SEA_BLOCKS) uniform usamplerBuffer sea_blocks;    // first column, first row, sides, 0
layout(binding = SEA_COLUMNS) uniform samplerBuffer sea_columns;   // per wave and column of cells
layout(binding = SEA_ROWS) uniform samplerBuffer sea_rows;         // per wave and strip of cells, for its first row
layout(std430, binding = INCIDENT_SEA) restrict writeonly buffer IncidentSea { vec4 incident[]; };

/// Share of the sea over a bed of this depth: the waves belong to the scene's full depth.
float seaShare(float depth_m) { return clamp((depth_m / sim.wave_depth_m - 0.6) / 0.3, 0.0, 1.0); }

vec2 product(vec2 a, vec2 b) { return vec2(a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x); }

void main() {
  const uint place = sea_first_block + sea_block_stride * gl_GlobalInvocationID.y;
  if (place >= sea_block_count) return;
  const uvec4 block = texelFetch(sea_blocks, int(place));
  const ivec2 n = waveCounts();
  const int x = int(block.x + gl_LocalInvocationID.x);
  if (x >= n.x) return;
  const int first_strip = int(block.y) / SEA_STRIP;
  const int strip_count = (n.y + SEA_STRIP - 1) / SEA_STRIP;
  const int end_strip = min(first_strip + SEA_BLOCK / SEA_STRIP, strip_count);
  for (int strip = first_strip; strip < end_strip; ++strip) {
    vec4 sums[SEA_STRIP];    // elevation, flow toward +x and +z, part of x in the elevation
    vec2 before[SEA_STRIP];  // flow through the faces toward -x and -z, at those edges only
    for (int k = 0; k < SEA_STRIP; ++k) {
      sums[k] = vec4(0.0);
      before[k] = vec2(0.0);
    }
    const bool at_begin = (x == 0 && (block.z & uint(MINUS_X_BIT)) != 0u) || (strip == 0 && (block.z & uint(MINUS_Z_BIT)) != 0u);
    const uint edge_wave_count = at_begin ? sea_wave_count : 0u;
    for (uint w = 0u; w < sea_wave_count; ++w) {
      const SeaWaveUniform each = sea_waves[w];
      if ((each.sides & block.z) == 0u) continue;
      const vec2 column = texelFetch(sea_columns, int(w) * n.x + x).xy;
      vec2 row = texelFetch(sea_rows, int(w) * strip_count + strip).xy;
      const vec2 next = vec2(each.next_re, each.next_im);
      const vec4 strength_re = vec4(each.elevation_re, each.flow_x_re, each.flow_z_re, each.share_of_x * each.elevation_re);
      const vec4 strength_im = vec4(each.elevation_im, each.flow_x_im, each.flow_z_im, each.share_of_x * each.elevation_im);
      const vec4 re = strength_re * column.x - strength_im * column.y;
      const vec4 im = strength_re * column.y + strength_im * column.x;
      for (int k = 0; k < SEA_STRIP; ++k) {
        sums[k] += re * row.x - im * row.y;
        row = product(row, next);
      }
    }
    for (uint w = 0u; w < edge_wave_count; ++w) {
      const SeaWaveUniform each = sea_waves[w];
      if ((each.sides & block.z) == 0u) continue;
      const vec2 column = texelFetch(sea_columns, int(w) * n.x + x).xy;
      const vec2 next = vec2(each.next_re, each.next_im);
      vec2 row = texelFetch(sea_rows, int(w) * strip_count + strip).xy;
      const vec2 flow_x = product(vec2(each.flow_x_re, each.flow_x_im), product(column, vec2(each.before_re, each.before_im)));
      const vec2 flow_z = product(vec2(each.flow_z_re, each.flow_z_im), product(column, vec2(next.x, -next.y))) / dot(next, next);
      for (int k = 0; k < SEA_STRIP; ++k) {
        before[k] += vec2(product(flow_x, row).x, product(flow_z, row).x);
        row = product(row, next);
      }
    }
    for (int k = 0; k < SEA_STRIP; ++k) {
      const int z = SEA_STRIP * strip + k;
      if (z >= n.y) break;
      const int i = x + n.x * z;
      vec2 inflow_m2ps = vec2(0.0);
      if (x == 0 && (block.z & uint(MINUS_X_BIT)) != 0u) inflow_m2ps.x += before[k].x;
      if (z == 0 && (block.z & uint(MINUS_Z_BIT)) != 0u) inflow_m2ps.y += before[k].y;
      if (x == n.x - 1 && (block.z & uint(PLUS_X_BIT)) != 0u) inflow_m2ps.x -= sums[k].y;
      if (z == n.y - 1 && (block.z & uint(PLUS_Z_BIT)) != 0u) inflow_m2ps.y -= sums[k].z;
      const vec4 ground = texelFetch(bed, i);
#if MATCHED
      const vec2 loss_per_s = ground.yw;
#else
      const vec2 loss_per_s = ground.yy;
#endif
      vec2 parts = vec2(sums[k].w, sums[k].x - sums[k].w);
      // Without gravity nothing is lost in the layer, and nothing comes in.
      if (inflow_m2ps.x != 0.0 && loss_per_s.x > 0.0) parts.x += inflow_m2ps.x * ELEVATION_UNITS_PER_M / (loss_per_s.x * sim.wave_cell_m);
      if (inflow_m2ps.y != 0.0 && loss_per_s.y > 0.0) parts.y += inflow_m2ps.y * ELEVATION_UNITS_PER_M / (loss_per_s.y * sim.wave_cell_m);
      const vec2 open = vec2(greaterThan(texelFetch(basin, i).xy, vec2(0.0)));
      incident[i] = seaShare(ground.z) * vec4(parts.x, open * sums[k].yz, parts.y);
    }
  }
}
