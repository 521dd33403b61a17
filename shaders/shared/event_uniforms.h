// Effects that act on the wave during one wave substep. Each adds gain * shape(x, z) to the elevation now and, for a
// travelling crest, the matching value one substep ago; the gains of an effect's pulse sum to its full amplitude.
#ifndef SPINDRIFT_SHARED_EVENT_UNIFORMS_H
#define SPINDRIFT_SHARED_EVENT_UNIFORMS_H

#include "shared/bindings.h"
#include "shared/dual.h"

#define MAX_EVENTS 32
// Values of EventUniform.kind.
#define EVENT_SPLASH 0
#define EVENT_CREST 1

#ifdef __cplusplus
namespace spindrift::shared {
struct EventUniform {
#else
struct EventUniform {
#endif
  uint kind;
  float gain_m;        // this substep's share of the amplitude; negative pushes down
  float x_m;           // splash: centre. crest: direction of travel (x, z), a unit vector along an axis
  float z_m;
  float radius_m;      // splash: radius. crest: half width, the e-folding length of exp(-(s/radius)^2)
  float offset_m;      // crest: position of the crest along its direction now
  float step_m;        // crest: how far it travels in one substep
  float mean_ratio;    // crest: mean of the shape over the domain, subtracted so that the volume stays
#ifdef __cplusplus
};
struct EventUniforms {
  EventUniform events[MAX_EVENTS];
  uint event_count;
  uint padding[3];
};
static_assert(sizeof(EventUniform) == 32 && sizeof(EventUniforms) == 32 * MAX_EVENTS + 16);
}  // namespace spindrift::shared
#else
};
layout(std140, binding = EVENT_UNIFORMS) uniform EventUniforms {
  EventUniform events[MAX_EVENTS];
  uint event_count;
};
#endif

#endif
