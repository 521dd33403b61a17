// What comes through the sides that have wave-makers (wave/maker.comp), for the momentum of the cells beside them.
#ifndef SPINDRIFT_MAKER_FLOW
#define SPINDRIFT_MAKER_FLOW

#include "wave/maker_side.glsl"

layout(binding = MAKER_FLOW) uniform samplerBuffer maker_flow;

/// Velocity and flow through a side, toward + along its axis; FLOW has none there, because the side is closed. `along`: the
/// number of the cell along the side.
vec2 makerFlow(uint side, int along, ivec2 n) { return texelFetch(maker_flow, makerBegin(side, n) + along).xy; }

#endif
