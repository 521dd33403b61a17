// Particles that meet floaters at the end of a substep. One invocation per particle, in two passes: HITS=0 counts the particles that hit
// each floater, HITS=1 moves them out and gives each floater what they lose.
// Reads FLOATERS, FLOATER_TILES and FLOATER_PLACES of this tick, the floor. HITS=0 adds to the last words of FLOATER_PUSH; HITS=1 updates
// POSITION and VELOCITY, and adds to FLOATER_PUSH (bodies/floater_recoil.comp applies it).
// A hit is an inelastic collision without friction. Of n at once each meets an n-th of the floater's mass M (mass splitting; Tonge,
// Benevolenski & Voroshilov 2012): the impulse j = -u / (1/m + n y/M), u being the normal relative velocity and y/M the floater's inverse
// mass at the point. So the floater gets at most the largest u, however light it is, and both sides get the same j.
// Only what is more than a spacing above the surface pushes a floater: what is below in one-way scenes is water of the wave, which
// carries it already.
#include "shared/groups.h"
#include "bodies/floater_shape.glsl"
#include "bodies/floater_texels.glsl"
#include "bodies/floater_tiles.glsl"
#include "common/finite.glsl"
#include "particles/population.glsl"
#include "particles/sides.glsl"

layout(local_size_x = PARTICLE_GROUP) in;

layout(std430, binding = POSITION) restrict buffer Position { vec4 position[]; };
layout(std430, binding = VELOCITY) restrict buffer Velocity { vec4 velocity[]; };
layout(std430, binding = FLOATER_TILES) restrict readonly buffer FloaterTiles { uint tiles[]; };
layout(std430, binding = FLOATER_PUSH) restrict buffer FloaterPush { int floater_push[]; };
layout(binding = FLOATER_PLACES) uniform samplerBuffer places;
uniform float moved_s;  // how long floaters have moved since the last substep: a tick before the first, then not

const int kMarches = 8;
const float kNear = 0.01;   // of the spacing: a path as near as this to the hull meets it
const float kDeep = 0.1;    // of the spacing: deeper at the beginning of the step, a particle was inside
const float kLeave = 0.25;  // of the spacing: so far a particle that was inside moves out per substep

/// Where a particle met a floater: the point from its centre of mass, the normal there, and how far to move the particle along it.
struct Hit {
  vec3 r;
  vec3 normal;
  float lift_m;
};

/// Returns whether a particle that ends at `end` from the centre, after a path relative to the floater, has met it. The path is searched
/// by steps of the distance to the hull, so that none passes through a thin plank.
bool meets(Floater b, vec3 end, vec3 path_m, out Hit hit) {
  const float near_m = kNear * sim.spacing_m;
  float left_m = length(path_m);
  const vec3 way = path_m / max(left_m, 1e-9);
  vec3 at = end - path_m;
  vec4 hull = surfaceOf(b, at);
  const bool was_inside = hull.w < -kDeep * sim.spacing_m;
  for (int k = 0; k < kMarches && hull.w > near_m && hull.w <= left_m; ++k) {
    at += hull.w * way;
    left_m -= hull.w;
    hull = surfaceOf(b, at);
  }
  if (was_inside || hull.w > near_m) {
    at = end;
    hull = surfaceOf(b, at);
  }
  const float depth_m = -(hull.w + dot(end - at, hull.xyz));
  hit = Hit(at, hull.xyz, was_inside ? min(depth_m, kLeave * sim.spacing_m) : depth_m);
  return depth_m > 0.0;
}

ivec3 pushUnits(vec3 change) { return ivec3(round(clamp(change, vec3(-64.0), vec3(64.0)) * PUSH_UNITS)); }

/// Takes the particle's velocity toward the floater away. `crowd`: particles that push the floater now; 0: it does not feel this one.
void collide(uint slot, Floater b, Hit hit, int crowd, inout vec3 v) {
  const float approach_mps = dot(b.velocity_mps + cross(b.spin_radps, hit.r) - v, hit.normal);
  if (approach_mps <= 0.0) return;
  const vec3 lever = cross(hit.r, hit.normal);
  const vec3 turned = spinOf(b, lever);
  const float mass_ratio = sim.mass_kg / (b.density_ratio * sim.rest_density_kgpm3 * volumeOf(b));
  const float impulse_mps = approach_mps / (1.0 + float(crowd) * mass_ratio * (1.0 + dot(lever, turned)));
  v += impulse_mps * hit.normal;
  if (crowd == 0) return;
  const ivec3 change = pushUnits(-mass_ratio * impulse_mps * hit.normal);
  const ivec3 spin = pushUnits(-mass_ratio * impulse_mps * turned);
  for (int axis = 0; axis < 3; ++axis) {
    atomicAdd(floater_push[8u * slot + axis], change[axis]);
    atomicAdd(floater_push[8u * slot + 3u + axis], spin[axis]);
  }
}

/// First word of the tile at a position.
uint tileOf(vec2 xz, uint words) {
  const float n = float(FLOATER_TILES_PER_AXIS);
  const ivec2 tile = ivec2(floor(clamp((xz + waveHalf_m()) * n / (2.0 * waveHalf_m()), vec2(-n), vec2(2.0 * n - 1.0))));
  return tileAt(tile.x, tile.y, words);
}

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= particleCount()) return;
  const vec4 old_position = position[i];
  const vec4 old_velocity = velocity[i];
#if POOL_PARTICLES
  if (old_position.w == DEAD_ID) return;
#endif
  if (!isFinite(old_position.xyz)) return;
  vec3 x = old_position.xyz;
  vec3 v = old_velocity.xyz;
  const uint words = uint(tiles.length()) / uint(FLOATER_TILES_PER_AXIS * FLOATER_TILES_PER_AXIS);
  const uint here = tileOf(x.xz, words);
  const uint before = tileOf(x.xz - sim.dt_s * v.xz, words);
  bool has_met = false;
  for (uint word = 0u; word < words; ++word) {
    uint listed = tiles[here + word] | tiles[before + word];
    while (listed != 0u) {
      const uint slot = 32u * word + uint(findLSB(listed));
      listed &= listed - 1u;
      const vec4 place = texelFetch(places, int(slot));
      vec3 d = x - place.xyz;
      d.xz = acrossSides(d.xz);
      const float reach_m = place.w + sim.dt_s * length(v);
      if (dot(d, d) > reach_m * reach_m) continue;
      const Floater b = floaterAt(slot);
      vec3 end = x - b.centre_m;
      end.xz = acrossSides(end.xz);
      Hit hit;
      if (!meets(b, end, sim.dt_s * v - moved_s * (b.velocity_mps + cross(b.spin_radps, end)), hit)) continue;
#if POOL_PARTICLES
      const bool pushes = true;
#else
      const bool pushes = x.y > floorHeight(loadFloor(), x.xz) + sim.band_m + sim.spacing_m;
#endif
#if HITS
      collide(slot, b, hit, pushes ? max(floater_push[8u * slot + 7u], 1) : 0, v);
      x += hit.lift_m * hit.normal;
      has_met = true;
#else
      if (pushes) atomicAdd(floater_push[8u * slot + 7u], 1);
#endif
    }
  }
#if HITS
  if (!has_met) return;
  keepInside(x, v);
#if !POOL_PARTICLES
  x.y = max(x.y, floorHeight(loadFloor(), x.xz) + sim.floor_gap_m);
#endif
  keepBetweenWalls(x.y, v.y, sim.min_y_m, sim.max_y_m);
  position[i] = vec4(x, old_position.w);
  velocity[i] = vec4(v, old_velocity.w);
#endif
}
