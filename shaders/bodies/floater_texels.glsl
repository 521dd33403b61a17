// Floaters as passes read them that do not move them.
#ifndef SPINDRIFT_FLOATER_TEXELS
#define SPINDRIFT_FLOATER_TEXELS

#include "bodies/floater.glsl"

layout(binding = FLOATERS) uniform samplerBuffer floaters;

Floater floaterAt(uint slot) {
  vec4 t[FLOATER_TEXELS];
  for (int k = 0; k < FLOATER_TEXELS; ++k) t[k] = texelFetch(floaters, int(slot) * FLOATER_TEXELS + k);
  return unpackFloater(t);
}

#endif
