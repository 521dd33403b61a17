// Crests displace water and set it in motion, so that they travel in one direction (d'Alembert; breaking wave: thesis
// 3.6.4). Calmed discs slow the flow: a drag, so they move no water.
// Reads EventUniforms, CREST_PROFILE, BASIN, BED, ELEVATION. Adds to TRANSFER [nx x nz, units] for this step, and to FLOW [m^2/s] for
// the next step, half a step earlier as the leapfrog needs it; raises LIMIT_ARGS as wave/momentum.comp does.
// LATERAL: some crests have a finite width; those across the whole domain come from their profile alone (llvmpipe takes both sides of
// a branch).
// Invariant: a face's transfer is computed by one invocation; nothing passes a closed face.
#include "shared/groups.h"
#include "wave/displacement.glsl"
#include "common/event_shapes.glsl"

layout(local_size_x = WAVE_GROUP_X, local_size_y = WAVE_GROUP_Y) in;

layout(std430, binding = FLOW) restrict buffer FaceFlow { StoredFlow stored_flow[]; };

layout(binding = CREST_PROFILE) uniform samplerBuffer crest_profile;

/// What the calmed discs leave of the flow at a cell. Several at one position slow it as the strongest does.
float keptFlow(vec2 p) {
  float drag_ratio = 0.0;
  for (uint k = 0u; k < calm_count; ++k)
    drag_ratio = max(drag_ratio, calmDrag(calms[k], acrossSides(p - vec2(calms[k].x_m, calms[k].z_m))));
  return 1.0 - drag_ratio;
}

/// What a crest does at the faces that a cell owns, for a height of 1 m.
struct Crest {
  vec2 displaced_m2;  // along its direction, at the faces toward +x and +z
  vec3 elevation;     // at these and in the corner, half a step before
};

#if LATERAL
/// Position in the frame of a crest: nearest to where a paddle starts it, across periodic sides.
vec2 seenFrom(EventUniform e, vec2 p) {
  const vec2 start = vec2(e.x_m, e.z_m);
  return e.half_side_m == 0.0 ? start + acrossSides(p - start) : p;
}

/// A crest of finite width.
Crest lateralCrest(EventUniform e, vec2 p) {
  const float half_m = 0.5 * sim.wave_cell_m;
  const vec2 at_x = seenFrom(e, p + vec2(half_m, 0.0));
  const vec2 at_z = seenFrom(e, p + vec2(0.0, half_m));
  const vec2 displaced_m2 = vec2(crestDisplacement(e, at_x, vec2(0.0)), crestDisplacement(e, at_z, vec2(0.0)));
  e.offset_m -= e.half_step_m;
  return Crest(displaced_m2, vec3(crestElevation(e, at_x, vec2(0.0)), crestElevation(e, at_z, vec2(0.0)),
                                  crestElevation(e, seenFrom(e, p + vec2(half_m)), vec2(0.0))));
}
#endif

void main() {
  const ivec2 n = waveCounts();
  const ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(cell, n))) return;
  const float cell_m = sim.wave_cell_m;
  const int i = cell.x + n.x * cell.y;
  const vec2 p = waveCellCentre(cell);
  const Flow open = conductanceOf(cell, n);
  const ivec2 next = nextCells(cell, n);
  const vec4 shares = effectShares(cell, next, n);
  ivec2 moved = ivec2(0);
  Flow flow = Flow(0.0);
  // Counted by what is left: with its index as the counter Mesa repeats the body MAX_CRESTS times.
  for (uint left = crest_count; left > 0u; --left) {
    const uint k = crest_count - left;
    const EventUniform e = crests[k];
    const float units = e.gain_m * ELEVATION_UNITS_PER_M / cell_m;
    const vec2 d = vec2(e.direction_x, e.direction_z);
    const vec2 profile = texelFetch(crest_profile, int(k) * max(n.x, n.y) + (d.x != 0.0 ? cell.x : cell.y)).xy;
    Crest crest = Crest(profile.xx, profile.yyy);
#if LATERAL
    if (e.lateral_m > 0.0) crest = lateralCrest(e, p);
#endif
    const vec2 displaced_m2 = passing(-d * crest.displaced_m2, shares);
    moved += ivec2(transferUnits(displaced_m2.x, units), transferUnits(displaced_m2.y, units));
    flow += e.gain_m * e.speed_mps * FLOW_WEIGHTS * asFlow(vec4(d * crest.elevation.xy, vec2(d.x + d.y, d.y - d.x) * crest.elevation.z));
  }
  const float kept = keptFlow(p);
  addTransfers(i, next, open, moved);
#if DISPERSE
  flow = passing(flow, shares);
#endif
  flow *= Flow(greaterThan(open, Flow(0.0)));
#if NONLINEAR
  const float water_m = metresOf(heldUnits(texelFetch(elevation, i).x, stillDepth(i)));
  const vec2 there_m = vec2(metresOf(heldUnits(texelFetch(elevation, next.x).x, stillDepth(next.x))),
                            metresOf(heldUnits(texelFetch(elevation, next.y).x, stillDepth(next.y))));
  // Thin water takes the speed of water as deep as a tenth of the scene's: it would fly.
  const vec2 gained_mps = flow / max(0.5 * (water_m + there_m), vec2(0.1 * sim.wave_depth_m));
  const float max_mps = cell_m / sim.wave_dt_s;
  stored_flow[i] = kept * vec4(clamp(stored_flow[i].xy + gained_mps, -max_mps, max_mps), stored_flow[i].zw + flow);
#else
  stored_flow[i] = kept * (stored_flow[i] + flow);
#endif
}
