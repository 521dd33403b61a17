// First half of a wave step of nonlinear shallow water (BULK_NONLINEAR): velocities at the faces, and the water that moves.
// Reads ELEVATION [nx x nz, units], FLOW [nx x nz: velocity toward +x and +z, m/s; the water they carried, m^2/s], BED,
// PRESSURE_HEAD; with DISPERSE the static depth of faces (BASIN), DISPERSED and BREAKING.
// Writes FLOW of the next step, and TRANSFER [nx x nz, units], which wave/continuity.comp moves.
// Raises LIMIT_ARGS if a transfer could empty a cell, so that wave/given_share.comp runs over all cells.
// Equation: u_t + (u grad) u = -g grad(eta + head) - g n^2 |u| u / h^(4/3) - (kappa + sigma) u.
//   Advection conserves momentum (Stelling & Duinmeijer 2003): du = sum of inflow (u_there - u) over the mean water of both
//   cells. Along the axis of a face the velocity that water brings is of second order (van Leer 1979), except in bores. Advection
//   is bounded: a step takes at most all of the momentum that flows in.
//   The height at a face is that of the giving cell, limited second order (van Leer 1979), over the higher bed.
//   Where water runs together as fast as in a bore, cells press with h (du)^2 (von Neumann & Richtmyer 1950), so that bores
//   stay without ripples.
//   Waves and flow together cross at most about a cell in a step (FREE_COURANT); what is faster loses velocity.
//   Friction of the bed (Manning) is implicit, so it stops thin films.
// DISPERSE: slopes filtered by the dispersion take the place of those of the surface in water that is deep for its waves.
// Invariants: no water leaves a dry cell; a level surface without flow does not change in any bit, at any level of any pond.
#include "shared/groups.h"
#include "shared/side_bits.h"
#include "wave/dispersed_share.glsl"
#include "wave/pressure_head.glsl"
#include "wave/shallow_column.glsl"

layout(local_size_x = WAVE_GROUP_X, local_size_y = WAVE_GROUP_Y) in;

layout(binding = ELEVATION) uniform isamplerBuffer elevation;
layout(binding = FLOW) uniform samplerBuffer flow;
#if SEA
#include "wave/incident_sea.glsl"
#endif
layout(std430, binding = FLOW) restrict writeonly buffer NextFlow { vec4 next_flow[]; };
layout(std430, binding = TRANSFER) restrict writeonly buffer Transfer { ivec2 transfer[]; };
layout(std430, binding = LIMIT_ARGS) restrict buffer LimitArgs { uint limit_args[]; };

/// Share of the speed difference across a cell that its pressure may take from a face in a step; both faces together take
/// less than all.
#define MAX_PRESSED 0.45
/// Cells press fully where water runs together, across a cell, with the second share of sqrt(g h), and not at all below the first:
/// waves that do not break would lose height (`spindrift-study --case bar`).
#define PRESSED_FROM 0.016
#define PRESSED_FULL 0.048
/// Waves and flow together may cross this share of a cell in a step. What is faster loses velocity: in a step it is divided by 1 plus
/// COURANT_LOSS times the excess. The scene's step leaves room for waves that break, not for columns several times the
/// depth; their explicit step would gain energy.
#define FREE_COURANT 0.8
#define COURANT_LOSS 4.0
/// In a step, velocities are divided by 1 plus this number where columns alternate between high and empty and differ by more than the
/// second share of (dx/dt)^2/g; not at all below the first. Without these shares thin water at shores and bores lost
/// momentum (`spindrift-study --case momentum`).
#define ALTERNATING_LOSS 4.0
#define ALTERNATING_FROM 0.04
#define ALTERNATING_FULL 0.12

/// How much four columns in a row alternate, 0 to 1: 0 unless their levels go up and down from one to the next; then the
/// square of the middle difference over the water there, less where an outer difference is under a quarter of it or where the
/// step bears it. Such a pattern is not a wave: a step would throw water from each cell into its neighbours, and the next
/// one back.
float alternates(Column behind, Column here, Column there, Column beyond) {
  const vec3 rises = vec3(here.eta - behind.eta, there.eta - here.eta, beyond.eta - there.eta) * ELEVATION_UNIT_M;
  const bool turns = rises.x * rises.y < 0.0 && rises.y * rises.z < 0.0;
  const vec3 size_m = abs(rises);
  const float share = min(size_m.y / max(max(here.water_m, there.water_m), 1e-6), 1.0);
  const float max_mps = sim.wave_cell_m / sim.wave_dt_s;
  const float borne = smoothstep(ALTERNATING_FROM, ALTERNATING_FULL, size_m.y * sim.gravity_mps2 / (max_mps * max_mps));
  return turns ? borne * share * share * min(4.0 * min(size_m.x, size_m.z) / size_m.y, 1.0) : 0.0;
}

float vanLeer(float a, float b) { return a * b > 0.0 ? 2.0 * a * b / (a + b) : 0.0; }

/// The flow along and across the axis of a face, by the cells beside it.
struct Face {
  float before, own, after;  // velocity along the axis at the face before, at this one and at the next [m/s]
  float left, right;         // the same at the parallel faces on both sides
  float in_before, in_after; // water along the axis in the middle of the cell before and of the cell behind [m^2/s], toward +
  float in_left, in_right;   // water across the axis at both ends of the face, toward +
  float across;              // velocity across the axis at the face [m/s]
  float far_before, far_after; // velocity along the axis at the face before `before` and at the one behind `after`
};

/// What the slope of the velocity adds to the momentum that `through` [m^2/s] carries across the middle of a cell with the height
/// water_m, over that of the face it comes from: velocities at the faces before and after the cell, and at those beyond. The
/// velocity is that of the middle of the step, in which water moves on, and waves that travel with it by as much more: without
/// their part such waves steepen by themselves (`spindrift-study --case breaking-front`).
float steeperMomentum(float through, float water_m, float far_before, float before, float after, float far_after) {
  const bool forward = through > 0.0;
  const float limited = vanLeer(after - before, forward ? before - far_before : far_after - after);
  const float rise = forward ? limited : -limited;
  const float travelled_mps = abs(through) / max(water_m, 1e-6) + sqrt(sim.gravity_mps2 * water_m);
  return 0.5 * through * rise * max(1.0 - sim.wave_dt_s / sim.wave_cell_m * travelled_mps, 0.0);
}

/// Change of the velocity in a step by the water that flows in, and by the pressure of water that runs together. [m/s]
float advected(Face f, Column here, Column there) {
  const float mean_m = 0.5 * (here.water_m + there.water_m);
  if (mean_m <= 0.0) return 0.0;
  const float per_m = sim.wave_dt_s / sim.wave_cell_m;
  const float weight = per_m / mean_m;
  const vec4 inflow = weight * max(vec4(f.in_before, -f.in_after, f.in_left, -f.in_right), vec4(0.0));
  const vec2 differs = vec2(f.before, f.after) - f.own;
  const vec2 closing = max(vec2(differs.x, -differs.y), vec2(0.0));
  // A front is cells wide: its sensor reaches one cell to either side, so that its foot and its crest stay without ripples.
  const vec2 nearby = max(max(closing, closing.yx), max(vec2(f.far_before - f.before, f.after - f.far_after), vec2(0.0)));
  const vec2 breaks = smoothstep(vec2(PRESSED_FROM), vec2(PRESSED_FULL),
                                 nearby * inversesqrt(max(sim.gravity_mps2 * vec2(here.water_m, there.water_m), vec2(1e-12))));
  const vec2 steeper = (1.0 - breaks) * vec2(steeperMomentum(f.in_before, here.water_m, f.far_before, f.before, f.own, f.after),
                                             steeperMomentum(f.in_after, there.water_m, f.before, f.own, f.after, f.far_after));
  const float change = dot(inflow, vec4(f.before, f.after, f.left, f.right) - f.own) + weight * (steeper.x - steeper.y);
  const vec2 pressed = breaks * min(closing * per_m * vec2(here.water_m, there.water_m) / mean_m, vec2(MAX_PRESSED)) * closing;
  return change / max(dot(inflow, vec4(1.0)), 1.0) + pressed.x - pressed.y;
}

/// Velocity [m/s] and water [m^2/s] at a face after the step. `driving` is g dt times the slope; `a` the share of the
/// velocity that losses take in half a step; `gained` what an incoming sea adds.
vec2 movedFlow(Face f, Column behind, Column here, Column there, Column beyond, float driving, float a, float gained) {
  const float max_mps = sim.wave_cell_m / sim.wave_dt_s;
  float u = ((1.0 - a) * f.own + advected(f, here, there) - driving + gained) / (1.0 + a);
  u /= 1.0 + ALTERNATING_LOSS * alternates(behind, here, there, beyond);
  const float courant = (abs(u) + sqrt(sim.gravity_mps2 * max(here.water_m, there.water_m))) / max_mps;
  u /= 1.0 + COURANT_LOSS * max(courant - FREE_COURANT, 0.0);
  const bool forward = u > 0.0;
  const Column from = forward ? here : there;
  const Column to = forward ? there : here;
  float passing_m = passingWater_m(from, to);
  if (passing_m <= 0.0) return vec2(0.0);
  u /= 1.0 + sim.wave_dt_s * sim.wave_friction * sqrt(u * u + f.across * f.across) * exp2(-1.3333333 * log2(passing_m));
  // No sill between: the height at the face follows the slope of the water behind it.
  if (passing_m >= from.water_m) {
    const float before_m = forward ? behind.water_m : beyond.water_m;
    passing_m += 0.5 * (1.0 - abs(u) / max_mps) * vanLeer(to.water_m - from.water_m, from.water_m - before_m);
  }
  return vec2(u, u * passing_m);
}

void main() {
  const ivec2 n = waveCounts();
  const ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(cell, n))) return;
  // Flow reaches across every side, because it is 0 at closed ones; water is mirrored there.
  const int row = n.x * cell.y;
  const int z_before = wrapped(cell.y - 1, n.y);
  const int z_after = wrapped(cell.y + 1, n.y);
  const int row_before = n.x * z_before;
  const int row_after = n.x * z_after;
  const int x_before = wrapped(cell.x - 1, n.x);
  const int x_after = wrapped(cell.x + 1, n.x);
  const int i = cell.x + row;
  const int i_x = x_after + row;
  const int i_z = cell.x + row_after;

  const vec4 own = texelFetch(flow, i);
  vec4 at_before_x = texelFetch(flow, x_before + row);
  vec4 at_x = texelFetch(flow, i_x);
  vec4 at_before_z = texelFetch(flow, cell.x + row_before);
  vec4 at_z = texelFetch(flow, i_z);
  vec2 far_before = vec2(texelFetch(flow, wrapped(x_before - 1, n.x) + row).x, texelFetch(flow, cell.x + n.x * wrapped(z_before - 1, n.y)).y);
  vec2 far_after = vec2(texelFetch(flow, wrapped(x_after + 1, n.x) + row).x, texelFetch(flow, cell.x + n.x * wrapped(z_after + 1, n.y)).y);
  // Beyond a closed side water is mirrored.
#if !WAVE_PERIODIC_X
  if (cell.x == 0) far_before.x = -own.x;
  if (cell.x == n.x - 2) far_after.x = -own.x;
#endif
#if !WAVE_PERIODIC_Z
  if (cell.y == 0) far_before.y = -own.y;
  if (cell.y == n.y - 2) far_after.y = -own.y;
#endif
  // Through a side with a wave-maker water comes and goes as fast as beside it.
#if MAKERS & MINUS_X_BIT
  if (cell.x == 0) at_before_x.xz = own.xz;
  if (cell.x <= 1) far_before.x = at_before_x.x;
#endif
#if MAKERS & PLUS_X_BIT
  if (cell.x == n.x - 2) at_x.xz = own.xz;
  if (cell.x >= n.x - 3) far_after.x = at_x.x;
#endif
#if MAKERS & MINUS_Z_BIT
  if (cell.y == 0) at_before_z.yw = own.yw;
  if (cell.y <= 1) far_before.y = at_before_z.y;
#endif
#if MAKERS & PLUS_Z_BIT
  if (cell.y == n.y - 2) at_z.yw = own.yw;
  if (cell.y >= n.y - 3) far_after.y = at_z.y;
#endif
  const vec4 at_x_before_z = texelFetch(flow, x_after + row_before);
  const vec4 at_z_before_x = texelFetch(flow, x_before + row_after);
  const Face face_x = Face(at_before_x.x, own.x, at_x.x, at_before_z.x, at_z.x,
                           0.5 * (at_before_x.z + own.z), 0.5 * (own.z + at_x.z),
                           0.5 * (at_before_z.w + at_x_before_z.w), 0.5 * (own.w + at_x.w),
                           0.25 * (own.y + at_x.y + at_before_z.y + at_x_before_z.y), far_before.x, far_after.x);
  const Face face_z = Face(at_before_z.y, own.y, at_z.y, at_before_x.y, at_x.y,
                           0.5 * (at_before_z.w + own.w), 0.5 * (own.w + at_z.w),
                           0.5 * (at_before_x.z + at_z_before_x.z), 0.5 * (own.z + at_z.z),
                           0.25 * (own.x + at_z.x + at_before_x.x + at_z_before_x.x), far_before.y, far_after.y);

  const Column here = columnOf(i, texelFetch(elevation, i).x);
  const Column there_x = columnOf(i_x, texelFetch(elevation, i_x).x);
  const Column there_z = columnOf(i_z, texelFetch(elevation, i_z).x);
  const int mirrored_before_x = waveNeighbourX(cell.x - 1, n.x) + row;
  const int mirrored_before_z = cell.x + n.x * waveNeighbourZ(cell.y - 1, n.y);
  const int mirrored_beyond_x = waveNeighbourX(waveNeighbourX(cell.x + 1, n.x) + 1, n.x) + row;
  const int mirrored_beyond_z = cell.x + n.x * waveNeighbourZ(waveNeighbourZ(cell.y + 1, n.y) + 1, n.y);
  const Column behind_x = columnOf(mirrored_before_x, texelFetch(elevation, mirrored_before_x).x);
  const Column behind_z = columnOf(mirrored_before_z, texelFetch(elevation, mirrored_before_z).x);
  const Column beyond_x = columnOf(mirrored_beyond_x, texelFetch(elevation, mirrored_beyond_x).x);
  const Column beyond_z = columnOf(mirrored_beyond_z, texelFetch(elevation, mirrored_beyond_z).x);

  const int head = headAt(i);
  vec2 rise = vec2(drivingRise(here, there_x, headAt(i_x) - head),
                   drivingRise(here, there_z, headAt(i_z) - head));
#if DISPERSE
  const vec2 depth_m = texelFetch(basin, i).xy;
  const float breaks = breakingAt(i);
  const vec4 psi = texelFetch(dispersed, i);
  const DispersedShare share_x = dispersedShare(depth_m.x, here, there_x, max(breaks, breakingAt(i_x)), psi.z, awayFromMakers(vec2(cell) + vec2(1.0, 0.5), n));
  const DispersedShare share_z = dispersedShare(depth_m.y, here, there_z, max(breaks, breakingAt(i_z)), psi.w, awayFromMakers(vec2(cell) + vec2(0.5, 1.0), n));
  rise = vec2(1.0 - share_x.all, 1.0 - share_z.all) * rise + vec2(share_x.after, share_z.after) * psi.xy;
#endif
  const vec2 driving = sim.wave_pull * rise;

#if MATCHED
  const vec2 layer_loss = 0.5 * (texelFetch(bed, i).yw + vec2(texelFetch(bed, i_x).y, texelFetch(bed, i_z).w));
#elif OPEN
  const vec2 layer_loss = 0.5 * (texelFetch(bed, i).yy + vec2(texelFetch(bed, i_x).y, texelFetch(bed, i_z).y));
#else
  const vec2 layer_loss = vec2(0.0);
#endif
  const vec2 a = 0.5 * sim.wave_dt_s * (sim.wave_damping_per_s + layer_loss);
#if SEA
  const vec2 mean_m = 0.5 * (here.water_m + vec2(there_x.water_m, there_z.water_m));
  const vec2 gained = sim.wave_dt_s * layer_loss * incidentFlow(i) / max(mean_m, vec2(0.05 * sim.wave_depth_m));
#else
  const vec2 gained = vec2(0.0);
#endif
  vec2 flow_x = movedFlow(face_x, behind_x, here, there_x, beyond_x, driving.x, a.x, gained.x);
  vec2 flow_z = movedFlow(face_z, behind_z, here, there_z, beyond_z, driving.y, a.y, gained.y);
#if !WAVE_PERIODIC_X
  if (cell.x == n.x - 1) flow_x = vec2(0.0);
#endif
#if !WAVE_PERIODIC_Z
  if (cell.y == n.y - 1) flow_z = vec2(0.0);
#endif
  next_flow[i] = vec4(flow_x.x, flow_z.x, flow_x.y, flow_z.y);

  const ivec2 moved = ivec2(transferUnits(flow_x.y, sim.wave_transfer), transferUnits(flow_z.y, sim.wave_transfer));
  transfer[i] = moved;
  const uint held = uint(max(here.eta + here.depth, 0));
  if (mayEmpty(moved.x, held, uint(max(there_x.eta + there_x.depth, 0))) || mayEmpty(moved.y, held, uint(max(there_z.eta + there_z.depth, 0))))
    limit_args[0] = limitGroups();  // all invocations write the same number
}
