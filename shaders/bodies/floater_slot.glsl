// Which slots of FLOATERS are taken.
#ifndef SPINDRIFT_FLOATER_SLOT
#define SPINDRIFT_FLOATER_SLOT

#include "common/finite.glsl"
#include "shared/floaters.h"

/// From the slot's first texel; one whose state is not finite is there, too, so that the watchdog sees it.
bool isFloaterHere(vec4 texel) { return isNaN(texel.w) || texel.w >= 0.0; }

#endif
