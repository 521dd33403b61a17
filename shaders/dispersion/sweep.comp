// The last sweep on one grid.
// Reads DISPERSION_BEFORE, DISPERSION_STIFFNESS, DISPERSION_SWEEP and the right side of this grid. Writes DISPERSION_FACES;
// on the finest grid DISPERSED instead: F grad(eta), what wave/momentum.comp takes for depth times slope [m * units].
// Equation: phi += w (r - K phi); F grad(eta) = sum_j sqrt(c_j) phi_j.
#include "dispersion/sweep_strip.glsl"

layout(binding = DISPERSION_BEFORE) uniform samplerBuffer before_sweep;
#if FINEST
layout(std430, binding = DISPERSED) restrict writeonly buffer Dispersed { vec2 dispersed[]; };
#else
layout(std430, binding = DISPERSION_FACES) restrict writeonly buffer Faces { vec4 faces[]; };
#endif

vec4 faceAt(int x, int z, int n) { return texelFetch(before_sweep, x + n * z); }

void put(int i, vec4 phi) {
#if FINEST
  const vec4 shares = texelFetch(root_c, i) * phi;
  dispersed[i] = vec2(shares.x + shares.y, shares.z + shares.w);
#else
  faces[i] = phi;
#endif
}

void main() { sweepStrip(); }
