// Tests for finite numbers by their bits, because compilers may assume that there are no NaNs: they remove isnan(), and turn
// !(x < 0) into x >= 0, which is false for a NaN (seen on NVIDIA).
#ifndef SPINDRIFT_FINITE
#define SPINDRIFT_FINITE

bool isFinite(float x) { return (floatBitsToUint(x) & 0x7f800000u) != 0x7f800000u; }
bool isNaN(float x) { return (floatBitsToUint(x) & 0x7fffffffu) > 0x7f800000u; }
bool isFinite(vec3 v) { return isFinite(v.x) && isFinite(v.y) && isFinite(v.z); }

#endif
