// Two sweeps from zero on one grid, on the way down the V-cycle.
// Reads DISPERSION_STIFFNESS, DISPERSION_SWEEP, and as the right side ELEVATION with DISPERSION_ROOT_C (FINEST) or
// DISPERSION_RIGHT. Writes DISPERSION_FACES.
// Equation: phi_1 = w r, phi_2 = phi_1 + w (r - K phi_1). Each invocation computes phi_1 of the faces that it needs: that
// costs less than another pass.
#include "dispersion/sweep_strip.glsl"

layout(std430, binding = DISPERSION_FACES) restrict writeonly buffer Faces { vec4 faces[]; };

vec4 faceAt(int x, int z, int n) { return texelFetch(sweep_weight, x + n * z) * rightSideAt(ivec2(x, z), n); }

void put(int i, vec4 phi) { faces[i] = phi; }

void main() { sweepStrip(); }
