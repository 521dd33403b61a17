// The surface at a position, bilinear between cell centres.
#ifndef SPINDRIFT_SURFACE_SAMPLE
#define SPINDRIFT_SURFACE_SAMPLE

#include "wave/wave_cell.glsl"

layout(binding = SURFACE) uniform samplerBuffer surface_texels;
layout(binding = SURFACE_FLOW) uniform samplerBuffer flow_texels;

/// (elevation [m], d eta/dt [m/s], d eta/dx, d eta/dz), and the water's horizontal velocity.
vec4 surfaceUnder(vec2 xz, out vec2 flow_mps) {
  const int n = int(sim.wave_n);
  const vec2 u = (xz + 0.5 * sim.wave_side_m) / sim.wave_cell_m - 0.5;
  // Clamped, because positions may be non-finite or far away and become an index.
  const vec2 c = clamp(floor(u), vec2(-n), vec2(2 * n - 2));
  const vec2 t = u - c;
  const int x0 = waveNeighbourX(int(c.x), n);
  const int x1 = waveNeighbourX(int(c.x) + 1, n);
  const int z0 = n * waveNeighbourZ(int(c.y), n);
  const int z1 = n * waveNeighbourZ(int(c.y) + 1, n);
  flow_mps = mix(mix(texelFetch(flow_texels, x0 + z0).xy, texelFetch(flow_texels, x1 + z0).xy, t.x),
                 mix(texelFetch(flow_texels, x0 + z1).xy, texelFetch(flow_texels, x1 + z1).xy, t.x), t.y);
  return mix(mix(texelFetch(surface_texels, x0 + z0), texelFetch(surface_texels, x1 + z0), t.x),
             mix(texelFetch(surface_texels, x0 + z1), texelFetch(surface_texels, x1 + z1), t.x), t.y);
}

#endif
