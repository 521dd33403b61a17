// Pressure of hulls on the water: invocations (x, y) cover the square around a boat, z is its slot.
// Reads BOATS. Adds to PRESSURE_HEAD [nx x nz, units] (cleared before).
// A moving pressure disc of the hull's size (the thesis, 3.6.4, uses a point). With dispersion it leaves a Kelvin wake.
// Without, a boat slower than the waves carries a dent, a faster one drags a Mach wedge of half angle asin(c/U).
// A wave step takes the pressure at its start, as it takes the elevation. One field serves all wave steps of the next
// tick, so the hull presses where it will be at the mean of their starts: second order in the tick.
// MOVED: hulls that another program moves press with the water that they displace. What a boat pressed with is taken away again when
// its pose is set between two ticks: the head is in whole units, so nothing is left over.
#include "shared/fixed_point.h"
#include "shared/groups.h"
#include "bodies/hull_cells.glsl"

layout(local_size_x = PATCH_GROUP, local_size_y = PATCH_GROUP) in;

layout(binding = BOATS) uniform samplerBuffer boats;
layout(std430, binding = PRESSURE_HEAD) restrict buffer PressureHead { int pressure_head[]; };

#if MOVED
uniform int first_place;
uniform int head_sign;  // -1: takes away what the boat presses with
#endif

void main() {
#if MOVED
  const int place = first_place + int(gl_GlobalInvocationID.z);
#else
  const int place = int(gl_GlobalInvocationID.z);
#endif
  vec4 t[BOAT_TEXELS];
  for (int k = 0; k < BOAT_TEXELS; ++k) t[k] = texelFetch(boats, place * BOAT_TEXELS + k);
  const BoatState now = unpackBoat(t);
  if (now.age_s < 0.0) return;
  const BoatState b = drifted(now, 0.5 * (sim.tick_s - sim.wave_dt_s));
  const ivec2 n = waveCounts();
  const float cell_m = sim.wave_cell_m;
  const vec2 half_m = hullHalf(b);
  const ivec2 across = min(hullCells(b, half_m), n);
  if (any(greaterThanEqual(ivec2(gl_GlobalInvocationID.xy), across))) return;
  ivec2 cell = ivec2(floor((b.centre_m.xz + waveHalf_m()) / cell_m)) - across / 2 + ivec2(gl_GlobalInvocationID.xy);
  const vec2 d = waveCellCentre(cell) - b.centre_m.xz;
#if WAVE_PERIODIC_X
  cell.x = wrapped(cell.x, n.x);
#endif
#if WAVE_PERIODIC_Z
  cell.y = wrapped(cell.y, n.y);
#endif
  if (any(lessThan(cell, ivec2(0))) || any(greaterThanEqual(cell, n))) return;
#if MOVED
  const float head_m = b.is_moved ? movedHeadAt(b, half_m, d, cell.x + n.x * cell.y) : hullPeak(b, half_m) * hullShape(half_m, inHull(b, d));
#else
  const float head_m = hullPeak(b, half_m) * hullShape(half_m, inHull(b, d));
#endif
  // Skip a boat with a non-finite state; diagnostics count it.
  const int units = head_m * ELEVATION_UNITS_PER_M < TRANSFER_MAX_UNITS ? int(round(head_m * ELEVATION_UNITS_PER_M)) : 0;
#if MOVED
  if (units != 0) atomicAdd(pressure_head[cell.x + n.x * cell.y], head_sign * units);
#else
  if (units != 0) atomicAdd(pressure_head[cell.x + n.x * cell.y], units);
#endif
}
