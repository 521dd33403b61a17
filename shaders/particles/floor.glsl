// The floor that carries the particles: with COUPLED the water surface lowered by the band's thickness, otherwise the
// plane y = -band. Samples come from the SURFACE texels, written by coupling/sample_surface.comp.
#ifndef SPINDRIFT_FLOOR
#define SPINDRIFT_FLOOR

#include "wave/wave_cell.glsl"
#include "shared/sim_uniforms.h"

#if COUPLED
layout(binding = SURFACE) uniform samplerBuffer surface_texels;
layout(binding = SURFACE_FLOW) uniform samplerBuffer flow_texels;
#endif

/// Inputs of the lookups, in registers.
struct Floor {
  float band_m;
  ivec2 n;
  float inverse_cell_pm;
  float cell_m;
  vec2 half_m;
  float lead_s;
};

Floor loadFloor() {
  Floor f;
  f.band_m = sim.band_m;
  f.n = waveCounts();
  f.cell_m = sim.wave_cell_m;
  f.inverse_cell_pm = 1.0 / max(sim.wave_cell_m, 1e-9);
  f.half_m = waveHalf_m();
  f.lead_s = sim.surface_lead_s;
  return f;
}

#if COUPLED
/// (elevation, d eta/dt, d eta/dx, d eta/dz) of the nearest wave cell, with the elevation extrapolated to (x, z) along
/// the gradient: one fetch, second order in the cell size like the bilinear sample.
vec4 surfaceNear(Floor f, vec2 xz) {
  const vec2 u = (xz + f.half_m) * f.inverse_cell_pm;
  const vec2 c = floor(u);
  const ivec2 cell = ivec2(waveNeighbourX(int(c.x), f.n.x), waveNeighbourZ(int(c.y), f.n.y));
  vec4 s = texelFetch(surface_texels, cell.x + f.n.x * cell.y);
  s.x += dot(s.zw, (u - c - 0.5) * f.cell_m) + f.lead_s * s.y;
  return s;
}

/// The same four numbers and the flow, bilinear between cell centres.
vec4 surfaceAt(Floor f, vec2 xz, out vec2 flow_mps) {
  const vec2 u = (xz + f.half_m) * f.inverse_cell_pm - 0.5;
  const vec2 c = floor(u);
  const vec2 t = u - c;
  const int x0 = waveNeighbourX(int(c.x), f.n.x);
  const int x1 = waveNeighbourX(int(c.x) + 1, f.n.x);
  const int z0 = f.n.x * waveNeighbourZ(int(c.y), f.n.y);
  const int z1 = f.n.x * waveNeighbourZ(int(c.y) + 1, f.n.y);
  const vec2 f0 = mix(texelFetch(flow_texels, x0 + z0).xy, texelFetch(flow_texels, x1 + z0).xy, t.x);
  const vec2 f1 = mix(texelFetch(flow_texels, x0 + z1).xy, texelFetch(flow_texels, x1 + z1).xy, t.x);
  flow_mps = mix(f0, f1, t.y);
  const vec4 s0 = mix(texelFetch(surface_texels, x0 + z0), texelFetch(surface_texels, x1 + z0), t.x);
  const vec4 s1 = mix(texelFetch(surface_texels, x0 + z1), texelFetch(surface_texels, x1 + z1), t.x);
  vec4 s = mix(s0, s1, t.y);
  s.x += f.lead_s * s.y;
  return s;
}
#endif

/// Height of the floor under (x, z). [m]
float floorHeight(Floor f, vec2 xz) {
#if COUPLED
  return surfaceNear(f, xz).x - f.band_m;
#else
  return -f.band_m;
#endif
}

/// Height, unit normal and velocity of the floor under (x, z).
float floorState(Floor f, vec2 xz, out vec3 normal, out vec3 velocity_mps) {
#if COUPLED
  vec2 flow_mps;
  const vec4 s = surfaceAt(f, xz, flow_mps);
  normal = normalize(vec3(-s.z, 1.0, -s.w));
  velocity_mps = vec3(flow_mps.x, s.y, flow_mps.y);
  return s.x - f.band_m;
#else
  normal = vec3(0.0, 1.0, 0.0);
  velocity_mps = vec3(0.0);
  return -f.band_m;
#endif
}

#endif
