// Second half of a wave step: water moves through the faces, in whole units.
// Reads TRANSFER [nx x nz, units], BED. Updates ELEVATION [nx x nz, units] and, in basins with an absorbing side, OUTFLOW
// (units that have left through this cell since the start: low 24 bits, the rest). Lowers LIMIT_ARGS for the next step.
// Equation: eta_t = -div q - sigma eta. sigma is not 0 only in the layers of absorbing sides. In a sponge the flow has the
// same rate, so that plane waves along its normal enter it without reflection. Like the flow's loss, the loss is centred in
// the step, b = sigma dt/2:
//   eta+ = ((1 - b) eta + gain)/(1 + b), so lost = (2 eta + gain) b/(1 + b)
// The step then has the stability bound of water without losses, however large they are: with G the scaled gradient, A
// and B the losses of flow and elevation over half a step and m the mean of the flow before and after, |eta|^2 - |G
// eta|^2/4 + |m|^2 + |A m|^2 never grows, and |G| < 2 is the Courant bound. (Applied after the step, the loss
// exp(-sigma dt) lowered the bound by the factor sqrt((1 + exp(-sigma dt))/2).)
// SEA: sigma acts on eta - eta_in, eta_in being the sea that comes in.
// MATCHED: the layer is a PML (docs/absorption.md). The elevation has two parts, by the faces that the water came through,
// each with the loss rate of its axis: eta_x_t = -dq_x/dx - sigma_x eta_x, eta_z_t = -dq_z/dz - sigma_z eta_z. Updates
// ELEVATION_X [nx x nz, units], the part of x, inside the layer; that of z is the rest.
// Invariant: the sum of ELEVATION and OUTFLOW over the domain does not change by a single unit; no cell loses more than it holds.
#include "shared/groups.h"
#include "wave/water_column.glsl"

layout(local_size_x = WAVE_GROUP_X, local_size_y = WAVE_GROUP_Y) in;

layout(binding = TRANSFER) uniform isamplerBuffer transfer;
layout(std430, binding = ELEVATION) restrict buffer Elevation { int elevation[]; };
layout(std430, binding = LIMIT_ARGS) restrict writeonly buffer LimitArgs { uint limit_args[]; };
#if OPEN
layout(std430, binding = OUTFLOW) restrict buffer Outflow { uvec2 outflow[]; };
#if MATCHED
layout(std430, binding = ELEVATION_X) restrict buffer ElevationX { int elevation_x[]; };
// So that the difference of ELEVATION and ELEVATION_X stays in range.
#define ELEVATION_X_MAX_UNITS (ELEVATION_MAX_UNITS / 2)
#endif

/// What a level [units] loses in this step: b/(1 + b) of its sum before and after the gain.
float lossOf(float level, int gain, float b) { return round((2.0 * level + float(gain)) * (b / (1.0 + b))); }
#endif
#if SEA
#include "wave/incident_sea.glsl"
#endif

void main() {
  const ivec2 n = waveCounts();
  const ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(cell, n))) return;
  const int left = wrapped(cell.x - 1, n.x);
  const int row = n.x * cell.y;
  const int last_row = n.x * wrapped(cell.y - 1, n.y);
  const int i = cell.x + row;
  if (i == 0) limit_args[0] = 0u;

  const ivec4 own = texelFetch(transfer, i);
  const ivec4 from_left = texelFetch(transfer, left + row);
  const ivec4 from_before = texelFetch(transfer, cell.x + last_row);
  int gain = from_left.x - own.x + from_before.y - own.y;
#if STENCIL == 9
  const ivec4 from_corner = texelFetch(transfer, left + last_row);
  gain += from_corner.z - own.z + from_before.w - from_left.w;
#endif
#if OPEN
  const vec4 ground = texelFetch(bed, i);
  const float b = 0.5 * ground.y * sim.wave_dt_s;
#if SEA
  const vec2 incident = incidentElevation(i);
#else
  const vec2 incident = vec2(0.0);
#endif
#if MATCHED
  const int level_x = elevation_x[i];
  const int gain_x = from_left.x - own.x;
  const float wanted_x = lossOf(float(level_x) - incident.x, gain_x, b);
  const float wanted_z = lossOf(float(elevation[i] - level_x) - incident.y, gain - gain_x, 0.5 * ground.w * sim.wave_dt_s);
  const float wanted = clamp(wanted_x + wanted_z, -float(ELEVATION_MAX_UNITS), float(ELEVATION_MAX_UNITS));
#else
  const float wanted = clamp(lossOf(float(elevation[i]) - incident.x - incident.y, gain, b), -float(ELEVATION_MAX_UNITS), float(ELEVATION_MAX_UNITS));
#endif
  // If more than half of the elevation is lost in a step, water above the still level would be taken below the bed. The
  // float's last bit may be 128 units, so compare as floats and subtract integers.
  const uint held = heldUnits(elevation[i] + gain, ground.z);
  const int lost = wanted >= float(held) ? int(held) : int(wanted);
#if MATCHED
  if (ground.y + ground.w > 0.0) {
    // Where water lacks, both parts lose less.
    const float limited_x = wanted_x - round(0.5 * max(wanted - float(held), 0.0));
    const int lost_x = int(clamp(limited_x, -float(ELEVATION_MAX_UNITS), float(ELEVATION_MAX_UNITS)));
    const int change = clamp(gain_x - lost_x, -ELEVATION_MAX_UNITS, ELEVATION_MAX_UNITS);
    elevation_x[i] = clamp(level_x + change, -ELEVATION_X_MAX_UNITS, ELEVATION_X_MAX_UNITS);
  }
#endif
  // 24 bits, and the rest in a second word: 32 bits would overflow after 128 m of water through one cell, some hours of
  // storm.
  const int low = int(outflow[i].x) + lost;
  outflow[i] = uvec2(uint(low & 0xffffff), outflow[i].y + uint(low >> 24));
  gain -= lost;
#endif
  elevation[i] += gain;
}
