// Where the gauges are, those of the scene first, for shaders/diagnostics/gauges.comp.
#ifndef SPINDRIFT_SHARED_GAUGE_UNIFORMS_H
#define SPINDRIFT_SHARED_GAUGE_UNIFORMS_H

#include "shared/bindings.h"

#define MAX_GAUGES 64

#ifdef __cplusplus
namespace spindrift::shared {
struct GaugePlace {
  float column, row, unused_0, unused_1;
};
struct GaugeUniforms {
  GaugePlace gauges[MAX_GAUGES];
  uint gauge_count;
  uint unused[3];
};
static_assert(sizeof(GaugeUniforms) == 16 * MAX_GAUGES + 16);
}  // namespace spindrift::shared
#else
layout(std140, binding = GAUGE_UNIFORMS) uniform GaugeUniforms {
  vec4 gauge_places[MAX_GAUGES];  // column and row in cells, whole numbers at the centres of cells
  uint gauge_count;
};
#endif

#endif
