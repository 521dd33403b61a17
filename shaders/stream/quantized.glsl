// Numbers of the stream that are not of a plane.
#ifndef SPINDRIFT_QUANTIZED
#define SPINDRIFT_QUANTIZED

#include "common/finite.glsl"

uint millimetres(float x_m) { return isNaN(x_m) ? 0u : uint(int(round(clamp(x_m, -1e6, 1e6) * 1000.0))); }
/// -1..1 to -high..high, the low bits of the word.
uint quantizedSigned(float unit, float high) { return isNaN(unit) ? 0u : uint(int(round(clamp(unit, -1.0, 1.0) * high))); }

#endif
