// On the way up the V-cycle: adds the correction of the coarser grid, then sweeps once.
// Reads DISPERSION_BEFORE, DISPERSION_STIFFNESS, DISPERSION_SWEEP and the right side of this grid; DISPERSION_COARSE; the
// weights DISPERSION_FROM_X, DISPERSION_FROM_Z where obstacles make them uneven. Writes DISPERSION_FACES.
// Equation: phi = before + P coarse; phi += w (r - K phi). P: a coarse flux passes the open part of its face evenly; inside
// the block it goes where every cell gains the same height, without obstacles half each to both inner faces of its axis.
#include "dispersion/sweep_strip.glsl"

layout(binding = DISPERSION_BEFORE) uniform samplerBuffer before_correction;
layout(binding = DISPERSION_COARSE) uniform samplerBuffer coarse;
#if UNEVEN
layout(binding = DISPERSION_FROM_X) uniform samplerBuffer from_x;
layout(binding = DISPERSION_FROM_Z) uniform samplerBuffer from_z;
#endif
layout(std430, binding = DISPERSION_FACES) restrict writeonly buffer Faces { vec4 faces[]; };

vec4 faceAt(int x, int z, int n) {
  const int i = x + n * z;
  const int half_n = n / 2;
  const int block_x = x / 2;
  const int block_row = half_n * (z / 2);
  const vec4 here = texelFetch(coarse, block_x + block_row);
  const vec2 west = texelFetch(coarse, wrapped(block_x - 1, half_n) + block_row).xy;
  const vec2 south = texelFetch(coarse, block_x + half_n * wrapped(z / 2 - 1, half_n)).zw;
#if UNEVEN
  const vec4 wx = texelFetch(from_x, i);
  const vec4 wz = texelFetch(from_z, i);
  return texelFetch(before_correction, i) + vec4(wx.x * here.xy + wx.y * west + wx.z * here.zw + wx.w * south,
                                                 wz.x * here.xy + wz.y * west + wz.z * here.zw + wz.w * south);
#else
  const vec2 in_x = x % 2 == 1 ? here.xy : 0.5 * (here.xy + west);
  const vec2 in_z = z % 2 == 1 ? here.zw : 0.5 * (here.zw + south);
  return texelFetch(before_correction, i) + vec4(in_x, in_z);
#endif
}

void put(int i, vec4 phi) { faces[i] = phi; }

void main() { sweepStrip(); }
