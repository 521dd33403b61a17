// The floor of the particles as in particles/floor.glsl, which it replaces, from an RGBA32F texture: elevation [m],
// d eta/dt, d eta/dx, d eta/dz. The water of the wave has no horizontal velocity here.
#define SPINDRIFT_FLOOR
#include "wave/wave_cell.glsl"

struct Floor {
  float band_m;
};

Floor loadFloor() { return Floor(sim.band_m); }

#if COUPLED
layout(binding = 0) uniform sampler2D wave;

vec4 waveAt(ivec2 cell) {
  const ivec2 n = waveCounts();
  return texelFetch(wave, ivec2(waveNeighbourX(cell.x, n.x), waveNeighbourZ(cell.y, n.y)), 0);
}

float floorHeight(Floor f, vec2 xz) {
  const vec2 u = (xz + waveHalf_m()) / sim.wave_cell_m;
  const vec4 s = waveAt(ivec2(floor(u)));
  return s.x + dot(s.zw, (u - floor(u) - 0.5) * sim.wave_cell_m) - f.band_m;
}

float floorState(Floor f, vec2 xz, out vec3 normal, out vec3 velocity_mps) {
  const vec2 u = (xz + waveHalf_m()) / sim.wave_cell_m - 0.5;
  const ivec2 c = ivec2(floor(u));
  const vec2 t = u - floor(u);
  const vec4 s = mix(mix(waveAt(c), waveAt(c + ivec2(1, 0)), t.x), mix(waveAt(c + ivec2(0, 1)), waveAt(c + ivec2(1, 1)), t.x), t.y);
  normal = normalize(vec3(-s.z, 1.0, -s.w));
  velocity_mps = vec3(0.0, s.y, 0.0);
  return s.x - f.band_m;
}
#else
float floorHeight(Floor f, vec2 xz) { return -f.band_m; }

float floorState(Floor f, vec2 xz, out vec3 normal, out vec3 velocity_mps) {
  normal = vec3(0.0, 1.0, 0.0);
  velocity_mps = vec3(0.0);
  return -f.band_m;
}
#endif
