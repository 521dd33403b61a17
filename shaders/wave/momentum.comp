// First half of a wave step: the slope of the surface accelerates the flow through each face.
// Reads ELEVATION [nx x nz, units], PRESSURE_HEAD (boats, falling water), BASIN, BED, BREAKING if the scene has them.
// Updates FLOW [nx x nz, m^2/s per metre of face]. Writes TRANSFER [nx x nz, units], which wave/continuity.comp moves.
// Raises LIMIT_ARGS if a transfer could empty a cell, so that wave/given_share.comp runs over all cells.
// Equation: q_t = -g d grad(eta + head) - (kappa + sigma) q, centred in time. Together with wave/continuity.comp this
// is the leapfrog of eta_tt + kappa eta_t = div(g d grad eta) (thesis 3.21), with damping of the velocity term alone:
//   q+ = keep q - gain g dt d_face (eta_there - eta_here)/dx,  keep = (1 - a)/(1 + a), gain = 1/(1 + a), a = (kappa +
// sigma) dt/2
// STEEPEN: d grows with the elevation, d (1 + 3 s eta/d): to first order the speed of simple waves in shallow water
// (Whitham 1974, 13.10), so that crests overtake troughs. The growth is bounded. The mean of the factor over the
// elevations between two cells is used: the force is then the difference of a potential, and energy is conserved for
// elevations beyond the bounds, too. Breaking water loses its flow at the rate intensity * 2 sqrt(g/d).
// MATCHED: sigma is that of the matched layer, with one rate for the flow along x and one for the flow along z.
// SEA: in the layers of absorbing sides sigma acts on q - q_in, q_in being the flow of the sea that comes in.
// DISPERSE: F grad(eta + head) of the dispersion takes the place of d grad(eta + head).
// Invariant: a level surface without flow does not change in any bit; closed faces carry nothing.
#include "shared/fixed_point.h"
#include "shared/groups.h"
#include "wave/pressure_head.glsl"
#include "wave/transfer.glsl"
#include "wave/water_column.glsl"

layout(local_size_x = WAVE_GROUP_X, local_size_y = WAVE_GROUP_Y) in;

layout(binding = ELEVATION) uniform isamplerBuffer elevation;
#if DISPERSE
layout(binding = DISPERSED) uniform samplerBuffer dispersed;
#endif
#if BREAKERS
layout(binding = BREAKING) uniform samplerBuffer breaking;
#endif
#if SEA
#include "wave/incident_sea.glsl"
#endif
layout(std430, binding = FLOW) restrict buffer FaceFlow { Flow flow_m2ps[]; };
layout(std430, binding = TRANSFER) restrict writeonly buffer Transfer { Units transfer[]; };
layout(std430, binding = LIMIT_ARGS) restrict buffer LimitArgs { uint limit_args[]; };

int elevationAt(int i) { return texelFetch(elevation, i).x; }

/// Loss rate of flow at a cell, in addition to kappa. [1/s]
float lossAt(int i) {
  float loss_per_s = 0.0;
#if VARIED
  loss_per_s += texelFetch(bed, i).x;
#endif
#if BREAKERS
  loss_per_s += sim.breaking_loss_per_s * texelFetch(breaking, i).y;
#endif
  return loss_per_s;
}

#if MATCHED
/// Loss rates of the flow along x and along z in the matched layer, in addition. [1/s]
vec2 layerLossAt(int i) { return texelFetch(bed, i).yw; }
#elif SEA
/// The same in a sponge; lossAt() has them, too.
vec2 layerLossAt(int i) { return texelFetch(bed, i).yy; }
#endif

#if STEEPEN
/// Integral from 0 to `level` of 1 + growth_pu level between its bounds. [units]
float steepPotential(float level, float growth_pu) {
  const float low = -0.75 * sim.steepening_ratio;
  const float high = sim.steepening_ratio;
  const float inside = clamp(level, low / growth_pu, high / growth_pu);
  return inside + 0.5 * growth_pu * inside * inside + (1.0 + (level < inside ? low : high)) * (level - inside);
}

/// Mean of that factor over the elevations between two cells.
float steepFactor(int a, int b) {
  const float growth_pu = 3.0 * max(sim.steepening_ratio, 1e-6) * ELEVATION_UNIT_M / sim.wave_depth_m;
  const float step_units = float(b - a);
  const float middle = 1.0 + clamp(growth_pu * 0.5 * (float(a) + float(b)), -0.75 * sim.steepening_ratio, sim.steepening_ratio);
  // Inside the bounds this quotient equals the factor in the middle. Close elevations use that, because the quotient
  // would be inexact.
  const float steep = (steepPotential(float(b), growth_pu) - steepPotential(float(a), growth_pu)) / (abs(step_units) < 65536.0 ? 1.0 : step_units);
  return abs(step_units) < 65536.0 ? middle : steep;
}
#endif

void main() {
  const ivec2 n = waveCounts();
  const ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(cell, n))) return;
  const int right = wrapped(cell.x + 1, n.x);
  const int row = n.x * cell.y;
  const int next_row = n.x * wrapped(cell.y + 1, n.y);
  const int i = cell.x + row;

  const int i_x = right + row;
  const int i_z = cell.x + next_row;
  const int eta = elevationAt(i);
  const int eta_x = elevationAt(i_x);
  const int eta_z = elevationAt(i_z);
  const int here = eta + headAt(i);
  const int there_x = eta_x + headAt(i_x);
  const int there_z = eta_z + headAt(i_z);
#if STENCIL == 9
  const int i_d = right + next_row;
  const int eta_d = elevationAt(i_d);
  const int there_d = eta_d + headAt(i_d);
#endif

#if DISPERSE
  Flow conductance_m = asFlow(texelFetch(dispersed, i));  // the slope is in it
  const Flow slope = Flow(1.0);
#else
  Flow conductance_m = conductanceOf(cell, n);
#if STENCIL == 9
  const Flow slope = vec4(there_x - here, there_z - here, there_d - here, there_z - there_x);
#else
  const Flow slope = vec2(there_x - here, there_z - here);
#endif
#endif
#if STEEPEN
#if STENCIL == 9
  conductance_m *= vec4(steepFactor(here, there_x), steepFactor(here, there_z), steepFactor(here, there_d), steepFactor(there_x, there_z));
#else
  conductance_m *= vec2(steepFactor(here, there_x), steepFactor(here, there_z));
#endif
#endif

#if VARIED || BREAKERS
  const float own_loss_per_s = lossAt(i);
  Flow loss_per_s = 0.5 * (own_loss_per_s + asFlow(vec4(lossAt(i_x), lossAt(i_z), own_loss_per_s, own_loss_per_s)));
#if MATCHED
  loss_per_s += 0.5 * (layerLossAt(i) + vec2(layerLossAt(i_x).x, layerLossAt(i_z).y));
#endif
  const Flow a = 0.5 * sim.wave_dt_s * (sim.wave_damping_per_s + loss_per_s);
#else
  const float a = 0.5 * sim.wave_dt_s * sim.wave_damping_per_s;
#endif
  Flow driven = (1.0 - a) * flow_m2ps[i] - sim.wave_pull * conductance_m * slope;
#if SEA
  driven += sim.wave_dt_s * 0.5 * (layerLossAt(i) + vec2(layerLossAt(i_x).x, layerLossAt(i_z).y)) * incidentFlow(i);
#endif
  const Flow flow = driven / (1.0 + a);
  flow_m2ps[i] = flow;

  Units moved;
  for (uint k = 0u; k < OWNED_FACES; ++k) moved[k] = transferUnits(flow[k], sim.wave_transfer);
  transfer[i] = moved;
  const uint held = heldUnits(eta, stillDepth(i));
  const uint held_x = heldUnits(eta_x, stillDepth(i_x));
  const uint held_z = heldUnits(eta_z, stillDepth(i_z));
  bool may_empty = mayEmpty(moved.x, held, held_x) || mayEmpty(moved.y, held, held_z);
#if STENCIL == 9
  may_empty = may_empty || mayEmpty(moved.z, held, heldUnits(eta_d, stillDepth(i_d))) || mayEmpty(moved.w, held_x, held_z);
#endif
  if (may_empty) limit_args[0] = limitGroups();  // all invocations write the same number
}
