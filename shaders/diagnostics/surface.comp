// Health of the wave: one partial result per invocation, summed on the host in double and 64-bit integer precision.
// Reads ELEVATION [nx x nz, units], FLOW, BASIN, OUTFLOW, BREAKING, BOATS, FLOATERS. Writes PARTIAL_SUM, 12 words per invocation, floats
// as their bits: breaches (flows not finite or out of range, elevations out of range, non-finite boats and floaters), 0, max |eta|,
// number of breaking cells; sum of eta(t) eta(t - dt), sum of q^2/d over the faces, 0, 0; sum of ELEVATION >> 16, sum
// of ELEVATION & 0xffff, sums of OUTFLOW's upper and lower part (integers, so the volume is exact).
#include "shared/groups.h"
#include "common/finite.glsl"
#include "common/place_of.glsl"
#include "wave/transfer.glsl"
#include "wave/wave_faces.glsl"
#if NONLINEAR
#include "wave/water_column.glsl"
#endif

layout(local_size_x = REDUCE_GROUP) in;

layout(binding = ELEVATION) uniform isamplerBuffer elevation;
layout(binding = FLOW) uniform samplerBuffer flow;
#if EXCHANGE
layout(binding = OUTFLOW) uniform usamplerBuffer outflow;
#endif
#if HULLS
#include "bodies/boat.glsl"
layout(binding = BOATS) uniform samplerBuffer boats;
#endif
#if FLOATING
#include "bodies/floater_slot.glsl"
layout(binding = FLOATERS) uniform samplerBuffer floaters;
#endif
#if BREAKERS
layout(binding = BREAKING) uniform samplerBuffer breaking;
#endif
layout(std430, binding = PARTIAL_SUM) restrict writeonly buffer PartialSum { uvec4 partial_sum[]; };

void main() {
  const uint share = gl_GlobalInvocationID.x;
  const uint shares = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
  const ivec2 n = waveCounts();
  const float dt_over_dx = sim.wave_dt_s / sim.wave_cell_m;
  vec4 worst = vec4(0.0);
  vec4 sum = vec4(0.0);
  uvec4 volume = uvec4(0u);
  for (uint at = share; at < uint(n.x * n.y); at += shares) {
    const int i = int(at);
    const ivec2 cell = placeOf(i, n.x);
    const int left = wrapped(cell.x - 1, n.x);
    const int last_row = n.x * wrapped(cell.y - 1, n.y);
    const int units = texelFetch(elevation, i).x;
#if NONLINEAR
    const vec4 stored = texelFetch(flow, i);
    const vec2 own = stored.zw;
    const vec2 from_left = texelFetch(flow, left + n.x * cell.y).zw;
    const vec2 from_before = texelFetch(flow, cell.x + last_row).zw;
#else
    const Flow own = asFlow(texelFetch(flow, i));
    const Flow from_left = asFlow(texelFetch(flow, left + n.x * cell.y));
    const Flow from_before = asFlow(texelFetch(flow, cell.x + last_row));
#endif
    float inflow = from_left.x - own.x + from_before.y - own.y;
#if STENCIL == 9
    inflow += texelFetch(flow, left + last_row).z - own.z + from_before.w - from_left.w;
#endif
#if NONLINEAR
    const float motion = dot(own, stored.xy);
    // The potential energy of a column over land begins at the ground.
    const float ground_m = max(-stillDepth(i), 0.0);
    const bool is_below_bed = float(units) * ELEVATION_UNIT_M < -stillDepth(i) - 1e-5;
#else
    const Flow conductance_m = conductanceOf(cell, n);
    const float motion = dot(own, own / max(conductance_m, Flow(1e-6)));
    const float ground_m = 0.0;
    const bool is_below_bed = false;
#endif
    volume.x += uint(units >> 16);
    volume.y += uint(units & 0xffff);
#if EXCHANGE
    const uvec2 left_units = texelFetch(outflow, i).xy;
    volume.z += left_units.y;
    volume.w += left_units.x;
#endif
    // Elevations beyond the range of their units overflow: transferUnits() drops the transfer, and sums wrap around.
    const bool is_beyond = units > ELEVATION_MAX_UNITS || units < -ELEVATION_MAX_UNITS ||
                           is_below_bed || !all(lessThan(abs(own) * sim.wave_transfer, Flow(TRANSFER_MAX_UNITS)));
    if (is_beyond) {
      worst.x += 1.0;
      continue;
    }
    const float eta = metres(units);
    worst.z = max(worst.z, abs(eta) - ground_m);
    sum += vec4(eta * (eta - dt_over_dx * inflow) - ground_m * ground_m, motion, 0.0, 0.0);
#if BREAKERS
    worst.w += texelFetch(breaking, i).y > 0.0 ? 1.0 : 0.0;
#endif
  }
#if HULLS
  if (share == 0u) {
    for (int at = 0; at < int(boat_place_count) * BOAT_TEXELS; ++at) {
      const vec4 t = texelFetch(boats, at);
      worst.x += isFinite(t.x + t.y + t.z + t.w) ? 0.0 : 1.0;
    }
  }
#endif
#if FLOATING
  for (uint slot = share; slot < uint(textureSize(floaters)) / FLOATER_TEXELS; slot += shares) {
    vec4 all = vec4(0.0);  // not finite if a part is not: position, rotation, velocity, spin
    for (int k = 0; k < 4; ++k) all += texelFetch(floaters, int(slot) * FLOATER_TEXELS + k);
    const bool is_here = isFloaterHere(texelFetch(floaters, int(slot) * FLOATER_TEXELS));
    worst.x += is_here && !(isFinite(all.xyz) && isFinite(all.w)) ? 1.0 : 0.0;
  }
#endif
  partial_sum[3u * share] = floatBitsToUint(worst);
  partial_sum[3u * share + 1u] = floatBitsToUint(sum);
  partial_sum[3u * share + 2u] = volume;
}
