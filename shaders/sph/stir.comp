// Effects in a scene without a wave: they move the particles directly, once per tick.
// Reads EventUniforms. Changes POSITION [m] and VELOCITY [m/s]. (Scenes with a wave move the surface: shaders/wave.)
// Equation: a change of the surface by eta = div V moves the water below by -V/d horizontally and by eta (y + d)/d
// upward. The motion has no divergence, so the pressure solver does not counteract it. A splash leaves its cavity to
// collapse and gives its rim the crown's speed, outward and up; a crest sets its water in motion with u = c eta/d (long
// waves). The gains of a pulse sum to 1. Calmed discs slow the particles.
// Invariant: nothing moves by more than a quarter of the spacing in a tick, or out of the walls.
#include "shared/groups.h"
#include "common/event_shapes.glsl"
#include "common/finite.glsl"
#include "particles/population.glsl"

layout(local_size_x = PARTICLE_GROUP) in;

layout(std430, binding = POSITION) restrict buffer Position { vec4 position[]; };
layout(std430, binding = VELOCITY) restrict buffer Velocity { vec4 velocity[]; };

/// Radius from which a crown starts, in splash radii: a ring just outside of the splash.
const float CROWN_RADII = 1.1;
const float CROWN_WIDTH_RADII = 0.35;

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= unsortedCount()) return;
  const vec4 own = position[i];
  vec3 x = own.xyz;
  if (!isFinite(x)) return;  // left for diagnostics to count
  const float depth_m = sim.band_m;
  const float height_ratio = clamp((x.y + depth_m) / depth_m, 0.0, 1.0);  // 0 at the floor, 1 at the resting surface
  vec3 move_m = vec3(0.0);
  vec3 v_mps = velocity[i].xyz;
  for (uint k = 0u; k < splash_count; ++k) {
    const EventUniform e = splashes[k];
    const vec2 r_m = x.xz - vec2(e.x_m, e.z_m);
    move_m.xz -= e.gain_m / depth_m * splashDisplacement(r_m, e.radius_m);
    move_m.y += e.gain_m * height_ratio * splashElevation(r_m, e.radius_m);
    const float off = (length(r_m) / e.radius_m - CROWN_RADII) / CROWN_WIDTH_RADII;
    const vec3 outward = normalize(vec3(0.5 * r_m.x, 0.87 * length(r_m) + 1e-6, 0.5 * r_m.y));
    const float share = e.speed_mps > 0.0 ? height_ratio * height_ratio * exp(-off * off) : 0.0;
    v_mps += share * max(e.speed_mps - dot(v_mps, outward), 0.0) * outward;
  }
  for (uint k = 0u; k < crest_count; ++k) {
    const EventUniform e = crests[k];
    const vec2 d = vec2(e.direction_x, e.direction_z);
    const vec2 ends = crestEnds(e);
    const float eta = crestElevation(e, x.xz, ends);
    move_m.xz -= e.gain_m / depth_m * crestDisplacement(e, x.xz, ends) * d;
    move_m.y += e.gain_m * height_ratio * eta;
    v_mps.xz += e.gain_m * eta / depth_m * e.speed_mps * d;
  }
  float drag_ratio = 0.0;
  for (uint k = 0u; k < calm_count; ++k) drag_ratio = max(drag_ratio, calmDrag(calms[k], x.xz - vec2(calms[k].x_m, calms[k].z_m)));
  v_mps *= 1.0 - drag_ratio;
  x += move_m * min(1.0, 0.25 * sim.spacing_m / max(length(move_m), 1e-9));
#if PERIODIC_X
  x.x -= (sim.max_x_m - sim.min_x_m) * (step(sim.max_x_m, x.x) - step(x.x, sim.min_x_m));
#endif
#if PERIODIC_Z
  x.z -= (sim.max_z_m - sim.min_z_m) * (step(sim.max_z_m, x.z) - step(x.z, sim.min_z_m));
#endif
  x.xz = clamp(x.xz, vec2(sim.min_x_m, sim.min_z_m), vec2(sim.max_x_m, sim.max_z_m));
  x.y = clamp(x.y, sim.min_y_m, sim.max_y_m);
  position[i] = vec4(x, own.w);
  velocity[i].xyz = v_mps;
}
