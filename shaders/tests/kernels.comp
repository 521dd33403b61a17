// For tests: evaluates the kernels of particles/kernels.glsl at many distances.
// Writes KernelValues: for invocation i at r = i / (count - 1) * 1.25 H: W / density norm, -(dW/dr) / slope norm, viscosity, cubic.
#include "particles/kernels.glsl"

layout(local_size_x = 64) in;

uniform float support_radius_m;
uniform uint count;
layout(std430, binding = 0) restrict writeonly buffer KernelValues { vec4 kernel_values[]; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= count) return;
  const Support support = makeSupport(support_radius_m);
  const float r = float(i) / float(count - 1u) * 1.25 * support_radius_m;
  kernel_values[i] = vec4(densityShape(r * r, support), pressurePull(r * r, support) * r, viscosityLaplacian(r, support.H),
                          cubicShape(r * support.inverse_H));
}
