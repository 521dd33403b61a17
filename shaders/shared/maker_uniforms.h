// A wave-maker during one wave step (server/sim/wave_makers.cpp), for shaders/wave/maker.comp.
#ifndef SPINDRIFT_SHARED_MAKER_UNIFORMS_H
#define SPINDRIFT_SHARED_MAKER_UNIFORMS_H

#include "shared/bindings.h"
#include "shared/dual.h"
#include "shared/side_bits.h"

#ifdef __cplusplus
namespace spindrift::shared {
struct MakerUniforms {
#else
layout(std140, binding = MAKER_UNIFORMS) uniform MakerUniforms {
#endif
  uint maker_side;
  float maker_flow_m2ps;      // that comes in, toward the water
  float maker_elevation_m;    // of the cells at the side while nothing comes back
  float maker_absorbing_mps;  // flow per difference from that elevation
  float maker_depth_m;        // that the three belong to
#ifdef __cplusplus
  uint unused[3];
};
static_assert(sizeof(MakerUniforms) == 32);
}  // namespace spindrift::shared
#else
};
#endif

#endif
