// Breaking cells turn water into particles.
// Reads EMITTER, SURFACE, SURFACE_FLOW, BREAKING, BED. Writes POSITION, VELOCITY in free slots of the pool; takes
// droplet_units per particle from ELEVATION. A particle starts on the surface with the speed of the crest (the water's
// velocity, the wave's along it, and the rise of the surface, each slightly randomised) or of a splash's crown.
// Invariant: ELEVATION loses exactly droplet_units per particle, and no cell more than it holds. The slot of a particle
// depends on the order of invocations; the sort then orders particles by position.
#include "shared/groups.h"
#include "common/hash.glsl"
#include "wave/transfer.glsl"
#include "shared/pool.h"
#include "coupling/spray_source.glsl"

layout(local_size_x = PARTICLE_GROUP) in;

layout(binding = EMITTER) uniform usamplerBuffer emitter;

layout(binding = SURFACE_FLOW) uniform samplerBuffer flow_texels;
layout(binding = BREAKING) uniform samplerBuffer breaking;
layout(std430, binding = POOL) restrict buffer Pool { uint pool[]; };
layout(std430, binding = POSITION) restrict writeonly buffer Position { vec4 position[]; };
layout(std430, binding = VELOCITY) restrict writeonly buffer Velocity { vec4 velocity[]; };
layout(std430, binding = ELEVATION) restrict buffer Elevation { int elevation[]; };
uniform uint tick;

void main() {
  const ivec2 n = waveCounts();
  if (gl_GlobalInvocationID.x >= pool[POOL_EMITTING]) return;
  const int i = int(texelFetch(emitter, int(gl_GlobalInvocationID.x)).x);
  const ivec2 cell = ivec2(i % n.x, i / n.x);
  const vec4 surface = texelFetch(surface_texels, i);
  const vec4 broken = texelFetch(breaking, i);
  const float crown_mps = length(broken.zw);
  const float rate_mps = smoothRate(cell, n);

  const int amount = int(sim.droplet_units);
  int rest = amount;
  const int reach = int(sim.splat_reach_count);
  for (int dz = -2 * reach; dz <= 2 * reach; ++dz) {
    for (int dx = -2 * reach; dx <= 2 * reach; ++dx) {
      int at;
      const int share = sprayFrom(cell, ivec2(dx, dz), n, at);
      if (share != 0) atomicAdd(elevation[at], -share);
      rest -= share;
    }
  }
  if (rest != 0) atomicAdd(elevation[i], -rest);

  const vec3 r = random3(uvec3(uint(i), tick, sim.seed ^ 0x9e3779b9u));
  const vec3 t = random3(uvec3(uint(i), tick, sim.seed ^ 0x85ebca6bu));
  const vec2 flow_mps = texelFetch(flow_texels, i).xy;
  const vec2 ahead = flow_mps / max(length(flow_mps), 1e-3);
  const float speed_mps = sqrt(sim.gravity_mps2 * sim.wave_depth_m);
  const vec2 place_m = waveCellCentre(cell) + (r.xy - 0.5) * sim.wave_cell_m;
  const vec2 across_mps = (t.xy - 0.5) * 0.5 * speed_mps;
  vec3 v = vec3(0.0);
  const bool is_crown = crown_mps > rate_mps;
  v.xz = flow_mps + ahead * (0.15 + 0.45 * t.z) * speed_mps + across_mps;
  v.y = rate_mps * (0.5 + 0.9 * r.z) + 0.15 * speed_mps * t.z;
  // A crown leans outward by 20 to 45 degrees.
  if (is_crown) v = vec3(0.0, crown_mps * (0.6 + 0.5 * r.z), 0.0) + vec3(broken.z, 0.0, broken.w) * (0.35 + 0.4 * t.z) + 0.3 * vec3(across_mps.x, 0.0, across_mps.y);
  v *= min(1.0, 0.9 * sim.max_speed_mps / max(length(v), 1e-3));
  const uint slot = atomicAdd(pool[POOL_NEXT], 1u);
  // Any number that distinguishes particles; a float holds 24 bits of it.
  const uint id = hashed(uvec3(uint(i), tick, sim.seed)).x >> 8;
  position[slot] = vec4(place_m.x, surface.x + 0.25 * sim.spacing_m, place_m.y, float(id));
  velocity[slot] = vec4(v, 1.0);
}
