// The water's pressure on hulls that another program moves, in one wave step. One group per boat.
// Reads BOATS, ELEVATION [nx x nz, units], TERRAIN. Adds to HULL_FORCES, mean over the tick.
// A step sees the elevation at its start and the hull where it presses (bodies/press.comp), and so does this pass: what a hull
// gets is what it gives to the water. With w = hullFullness * hullShape, head = what the hull presses with and
// phi = elevation + head, the surface without the hull's own dent:
//   vertical:   rho g sum w (height below phi), of which that below the rest level is hydrostatic; it acts in the middle of the height
//               below, which leans with the hull
//   horizontal: rho g sum grad(head) (phi - mean of phi), as in bodies/kick.comp
// Then the energy of the water, 1/2 rho (g phi^2 + flow^2 / d) per area, grows by the work of the hull against the dynamic force:
// phi_t + div q = head_t and q_t = -g d grad(phi), a hull that sinks is a source of the water that it displaces.
// NONLINEAR: the difference of second order is the exact reaction of a step without dispersion (wave/shallow_momentum.comp);
// otherwise that of fourth order is closer to the energy of the waves (decision 104).
#include "shared/fixed_point.h"
#define MOVED 1
#include "bodies/hull_cells.glsl"
#include "common/place_of.glsl"

const uint kGroup = 64u;
layout(local_size_x = kGroup) in;

layout(binding = BOATS) uniform samplerBuffer boats;
layout(binding = ELEVATION) uniform isamplerBuffer elevation;
layout(std430, binding = HULL_FORCES) restrict buffer HullForces { vec4 hull_forces[]; };

/// Sums over the wet cells under a hull.
struct Sums {
  vec4 still;     // force upward under the rest level, its lever along and across; w of hullShape
  vec4 moving;    // the rest of the force upward, its lever; w phi
  vec3 push;      // grad(head) phi and its moment
  vec3 gradient;  // grad(head) and its moment
};
shared vec4 share_still[kGroup], share_moving[kGroup];
shared vec3 share_push[kGroup], share_gradient[kGroup];

/// Force on a column of the hull and its lever from the centre: it acts in the middle of the height below `level_m`.
vec3 liftOf(BoatState b, vec2 at_m, float w, float level_m, float below_m) {
  const float up_m = level_m - 0.5 * below_m - b.centre_m.y;  // from the centre
  return w * below_m * vec3(1.0, at_m.x - b.tilt.x * up_m, at_m.y + b.tilt.y * up_m);
}

/// The head some cells further; beyond a closed face that of this cell, because nothing drives water through it.
float headNear(BoatState b, vec2 half_m, vec2 d, ivec2 cell, ivec2 step) {
  const int i = wetCell(cell + step);
  return i < 0 ? movedHeadAt(b, half_m, d, wetCell(cell)) : movedHeadAt(b, half_m, d + vec2(step) * sim.wave_cell_m, i);
}

/// Derivative of the head along an axis.
float headSlope(BoatState b, vec2 half_m, vec2 d, ivec2 cell, ivec2 axis) {
  const float one = headNear(b, half_m, d, cell, axis) - headNear(b, half_m, d, cell, -axis);
#if NONLINEAR
  return one / (2.0 * sim.wave_cell_m);
#else
  const float two = headNear(b, half_m, d, cell, 2 * axis) - headNear(b, half_m, d, cell, -2 * axis);
  return (8.0 * one - two) / (12.0 * sim.wave_cell_m);
#endif
}

void add(inout Sums sums, BoatState b, vec2 half_m, ivec2 cell) {
  const int i = wetCell(cell);
  if (i < 0) return;
  const vec2 d = waveCellCentre(cell) - b.centre_m.xz;
  const vec2 at_m = inHull(b, d);
  const float depth_m = depthAt(i);
  const float shape = hullShape(half_m, at_m);
  const float w = hullFullness(b, half_m) * shape;
  const float eta_m = float(texelFetch(elevation, i).x) * ELEVATION_UNIT_M;
  const float phi_m = eta_m + movedHead(b, half_m, at_m, depth_m);
  // The surface of a dry cell is the ground.
  const bool is_wet = eta_m > -depth_m + 1e-4;
  const float still_m = hullBelow(b, at_m, 0.0, depth_m);
  const float below_m = is_wet ? hullBelow(b, at_m, phi_m, depth_m) : 0.0;
  const float keel_top_m = b.centre_m.y + 0.5 * b.hull_m.z + at_m.x * b.tilt.x - at_m.y * b.tilt.y;
  const vec3 still = liftOf(b, at_m, w, min(0.0, keel_top_m), still_m);
  sums.still += vec4(still, shape);
  sums.moving += vec4(liftOf(b, at_m, w, min(phi_m, keel_top_m), below_m) - still, shape * phi_m);
  const vec2 gradient = vec2(headSlope(b, half_m, d, cell, ivec2(1, 0)), headSlope(b, half_m, d, cell, ivec2(0, 1)));
  const vec3 with_moment = vec3(gradient, d.x * gradient.y - d.y * gradient.x);
  sums.gradient += with_moment;
  if (is_wet) sums.push += with_moment * phi_m;
}

/// The sum over all invocations, for the first one.
Sums totalOf(Sums share) {
  const uint own = gl_LocalInvocationID.x;
  share_still[own] = share.still;
  share_moving[own] = share.moving;
  share_push[own] = share.push;
  share_gradient[own] = share.gradient;
  memoryBarrierShared();
  barrier();
  if (own > 0u) return share;
  for (uint k = 1u; k < kGroup; ++k) {
    share.still += share_still[k];
    share.moving += share_moving[k];
    share.push += share_push[k];
    share.gradient += share_gradient[k];
  }
  return share;
}

void main() {
  const int place = int(gl_WorkGroupID.x);
  vec4 t[BOAT_TEXELS];
  for (int k = 0; k < BOAT_TEXELS; ++k) t[k] = texelFetch(boats, place * BOAT_TEXELS + k);
  const BoatState now = unpackBoat(t);
  if (now.age_s < 0.0 || !now.is_moved) return;
  const BoatState b = drifted(now, 0.5 * (sim.tick_s - sim.wave_dt_s));
  const vec2 half_m = hullHalf(b);
  const ivec2 across = min(hullCells(b, half_m) + 4, waveCounts());  // differences reach two cells further
  const ivec2 first = ivec2(floor((b.centre_m.xz + waveHalf_m()) / sim.wave_cell_m)) - across / 2;
  Sums share = Sums(vec4(0.0), vec4(0.0), vec3(0.0), vec3(0.0));
  for (int k = int(gl_LocalInvocationID.x); k < across.x * across.y; k += int(kGroup))
    add(share, b, half_m, first + placeOf(k, across.x));
  const Sums sums = totalOf(share);
  if (gl_LocalInvocationID.x > 0u) return;

  const float mean_m = sums.moving.w / max(sums.still.w, 1e-6);
  const vec3 push = sums.push - mean_m * sums.gradient;
  const float scale = sim.gravity_mps2 * sim.wave_cell_m * sim.wave_cell_m * sim.wave_dt_s / sim.tick_s;
  const uint at = uint(place) * HULL_FORCE_TEXELS;
  hull_forces[at] += scale * vec4(0.0, sums.still.x, 0.0, 0.0);
  hull_forces[at + 1u] += scale * vec4(-sums.still.z, sums.still.y, 0.0, 0.0);
  hull_forces[at + 2u] += scale * vec4(push.x, sums.moving.x, push.y, 0.0);
  hull_forces[at + 3u] += scale * vec4(-sums.moving.z, sums.moving.y, push.z, 0.0);
}
