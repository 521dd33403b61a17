// The plane waves of a wind sea during one wave step (server/sim/wind_sea.cpp), for shaders/wave/incident_sea.comp.
#ifndef SPINDRIFT_SHARED_SEA_UNIFORMS_H
#define SPINDRIFT_SHARED_SEA_UNIFORMS_H

#include "shared/bindings.h"
#include "shared/dual.h"

// Two seas while one fades into the next.
#define MAX_SEA_WAVES 64
// The sea is computed in blocks of this many cells along x and z. An invocation computes a column of a block.
#define SEA_BLOCK 16
// Rows that an invocation sums at a time: few enough for registers, and enough to make the two reads per wave cheap.
#define SEA_STRIP 4
// Blocks of one work group.
#define SEA_GROUP_BLOCKS 4

#ifdef __cplusplus
namespace spindrift::shared {
#endif
// Complex strengths: the real part of strength * SEA_COLUMNS * SEA_ROWS is the wave's share.
struct SeaWaveUniform {
  float elevation_re;  // [units], in the middle of the step
  float elevation_im;
  float flow_x_re;  // [m^2/s], at the face toward +x, at the begin of the step
  float flow_x_im;
  float flow_z_re;  // the same toward +z
  float flow_z_im;
  float next_re;  // factor from one row of cells to the next
  float next_im;
  float before_re;  // factor from one column of cells to the one before
  float before_im;
  uint sides;        // absorbing sides in whose layers the wave is present (sim_setup/sea_state.h)
  float share_of_x;  // of the elevation: the part that the flow along x makes, kx^2/k^2
};
#ifdef __cplusplus
struct SeaUniforms {
  SeaWaveUniform waves[MAX_SEA_WAVES];
  uint wave_count;
  uint first_block;
  uint block_stride;
  uint block_count;
};
static_assert(sizeof(SeaWaveUniform) == 48 && sizeof(SeaUniforms) == 48 * MAX_SEA_WAVES + 16);
}  // namespace spindrift::shared
#else
layout(std140, binding = SEA_UNIFORMS) uniform SeaUniforms {
  SeaWaveUniform sea_waves[MAX_SEA_WAVES];
  uint sea_wave_count;
  uint sea_first_block;  // this dispatch computes the blocks first, first + stride, ... below the count
  uint sea_block_stride;
  uint sea_block_count;
};
#endif

#endif
