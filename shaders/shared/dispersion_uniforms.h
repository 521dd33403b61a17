// One grid of the dispersion's V-cycle, for shaders/dispersion. A block and not plain uniforms: the passes run one after the other
// over grids of different sizes, and a driver on which this is tested (zink of Mesa 22.3) keeps plain uniforms of the call before where
// they decide loops.
#ifndef SPINDRIFT_SHARED_DISPERSION_UNIFORMS_H
#define SPINDRIFT_SHARED_DISPERSION_UNIFORMS_H

#include "shared/bindings.h"
#include "shared/dual.h"

#ifdef __cplusplus
namespace spindrift::shared {
struct DispersionUniforms {
#else
layout(std140, binding = DISPERSION_UNIFORMS) uniform DispersionUniforms {
#endif
  uint grid_nx;     // cells along x and z
  uint grid_nz;
  uint coarse_nx;   // cells along x of the next coarser grid; 0 in the coarsest
  uint grid_count;  // bottom.comp: grids from this one to the coarsest
#ifdef __cplusplus
};
static_assert(sizeof(DispersionUniforms) == 16);
}  // namespace spindrift::shared
#else
};
#endif

#endif
