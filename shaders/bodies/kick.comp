// Second half of a tick of every boat: the water's forces, thrust and drag change its velocities. One group per boat.
// Reads SURFACE, SURFACE_FLOW, TERRAIN, BoatControls. Updates BOATS.
// Leapfrog: positions are those at the end of a tick, velocities those half a tick later. bodies/drift.comp has moved the
// boat to the time at which SURFACE was sampled; the kick is centred there. Inside the kick, forces act for half a tick
// before and after the drags, which are solved exactly (Strang 1968).
// The hull is a distribution of volume over wave cells, the same that presses on the water (bodies/press.comp). With w =
// hullShape and phi = elevation + own head, the surface without the hull's own dent:
//   heave, pitch, roll: each cell is submerged from its keel to phi; draught at rest = density ratio * height
//   surge, sway, yaw:   force = rho g sum grad(head) (phi - mean of phi), the reaction of the pressure on the water: the
//   energy that waves carry away is taken from the boat (wave-making resistance, Havelock 1932). grad is a central
//   difference of fourth order. It is antisymmetric, so sum head grad(head) is 0 and phi may stand for the elevation; a
//   dent at rest gives no force beside a wall either, because phi is level there.
// Thrust balances quadratic drag, relative to the moving water, at full speed; the rudder turns a moving boat on a circle
// of about two lengths. A boat thrown up by waves falls freely: forces but buoyancy are multiplied by min(1, 2 s), s
// being the share of its weight that the water carries.
// NONLINEAR: ground under the keel carries, too, and holds the hull by friction: boats run aground and float off.
// MOVED: a boat that another program moves keeps its velocities. Of the forces on it, the resistance comes from here, in
// HULL_FORCES; bodies/hull_forces.comp has those of the pressure.
#include "bodies/boat.glsl"
#include "wave/wave_cell.glsl"
#if WAVE
layout(binding = SURFACE) uniform samplerBuffer surface_texels;
layout(binding = SURFACE_FLOW) uniform samplerBuffer flow_texels;
#endif
#include "bodies/hull_cells.glsl"
#include "common/place_of.glsl"

const uint kGroup = 64u;
layout(local_size_x = kGroup) in;

layout(std430, binding = BOATS) restrict buffer Boats { vec4 boats[]; };
#if MOVED
layout(std430, binding = HULL_FORCES) restrict buffer HullForces { vec4 hull_forces[]; };
#endif

const float kHeaveDamping = 0.3;      // of critical
const float kTiltDamping = 0.25;      // of critical
const float kDragPerLength = 0.35;    // quadratic drag over the length: full speed within a few lengths
const float kReverseShare = 0.4;      // thrust astern over thrust ahead
const float kTurnLengths = 1.6;       // radius of the tightest circle over the length
const float kYawRate_per_s = 3.0;     // rate at which the boat follows its rudder
const float kWashYaw_per_s = 0.25;    // turning by the propeller's wash at standstill
const float kSwayDrag_per_s = 2.5;
#if NONLINEAR
const float kGroundStiffness = 15.0;  // weight that ground carries over that of water as high as the keel stands in it
const float kGroundFriction = 0.5;    // of a hull on sand: a boat rests on slopes up to 1 in 2
const float kGroundYaw_per_s = 4.0;   // rate at which a grounded hull stops turning
#endif

/// Sums over the wet cells under a hull, with w = hullShape.
struct HullSums {
  vec4 lift;      // w (1, submerged [m], submerged * along, submerged * across)
  vec4 spread;    // w (along, across, along^2, across^2)
  vec4 water;     // w (1, velocity x, z, up [m/s]), w of the hull where it was when the flow was sampled
  vec4 gradient;  // grad(w) and its moment about the centre; w phi
#if NONLINEAR
  float ground;   // w times the part of submerged that the ground carries [m]
#endif
  vec3 push;      // the same times phi [m]
};
shared vec4 share_lift[kGroup], share_spread[kGroup], share_water[kGroup], share_gradient[kGroup];
shared vec3 share_push[kGroup];
#if NONLINEAR
shared float share_ground[kGroup];
#endif

/// The surface without the hull's own dent. Without a wave, boats float at the resting level. [m]
float levelAt(int i, float own_head_m) {
#if WAVE
  return texelFetch(surface_texels, i).x + own_head_m;
#else
  return 0.0;
#endif
}

/// Difference of a function from its values one and two cells to both sides; fourth order.
float centralSlope(vec2 one, vec2 two) { return (8.0 * (one.x - one.y) - (two.x - two.y)) / (12.0 * sim.wave_cell_m); }

/// Gradient of the shape at d from the hull's centre, along x and z.
vec2 shapeGradient(BoatState b, vec2 half_m, vec2 d) {
  const vec2 x = inHull(b, vec2(sim.wave_cell_m, 0.0));
  const vec2 z = inHull(b, vec2(0.0, sim.wave_cell_m));
  const vec2 at_m = inHull(b, d);
  return vec2(centralSlope(vec2(hullShape(half_m, at_m + x), hullShape(half_m, at_m - x)),
                           vec2(hullShape(half_m, at_m + 2.0 * x), hullShape(half_m, at_m - 2.0 * x))),
              centralSlope(vec2(hullShape(half_m, at_m + z), hullShape(half_m, at_m - z)),
                           vec2(hullShape(half_m, at_m + 2.0 * z), hullShape(half_m, at_m - 2.0 * z))));
}

/// Adds one cell; `before` is the boat half a wave step ago, when the flow was sampled.
void add(inout HullSums sums, BoatState b, BoatState before, vec2 half_m, float peak_m, ivec2 cell) {
  const int i = wetCell(cell);
  if (i < 0) return;
  const vec2 d = waveCellCentre(cell) - b.centre_m.xz;
  const vec2 at_m = inHull(b, d);
  const float w = hullShape(half_m, at_m);
#if MOVED
  const float level_m = levelAt(i, b.is_moved ? movedHead(b, half_m, at_m, depthAt(i)) : peak_m * w);
#else
  const float level_m = levelAt(i, peak_m * w);
#endif
  const float keel_m = b.centre_m.y - 0.5 * b.hull_m.z + at_m.x * b.tilt.x - at_m.y * b.tilt.y;
#if NONLINEAR
  const float ground_m = -texelFetch(terrain, i).w;
  const float carried_m = kGroundStiffness * max(ground_m - keel_m, 0.0);
  // The surface of a dry cell is the ground, which carries in its own way.
  const bool is_wet = texelFetch(surface_texels, i).x > ground_m + 1e-4;
  const float submerged_m = (is_wet ? clamp(level_m - keel_m, 0.0, b.hull_m.z) : 0.0) + carried_m;
  sums.ground += w * carried_m;
#else
  const float submerged_m = clamp(level_m - keel_m, 0.0, b.hull_m.z);
#endif
  sums.lift += w * vec4(1.0, submerged_m, submerged_m * at_m);
  sums.spread += w * vec4(at_m, at_m * at_m);
#if WAVE
  const float w_before = hullShape(half_m, inHull(before, d + b.centre_m.xz - before.centre_m.xz));
  if (w_before > 0.0) sums.water += w_before * vec4(1.0, texelFetch(flow_texels, i).xy, texelFetch(surface_texels, i).y);
  const vec2 gradient = shapeGradient(b, half_m, d);
  const vec3 with_moment = vec3(gradient, d.x * gradient.y - d.y * gradient.x);
  sums.gradient += vec4(with_moment, w * level_m);
  sums.push += with_moment * level_m;
#endif
}

/// The sums of this invocation's share of the cells.
HullSums shareOf(BoatState b, vec2 half_m, float peak_m) {
#if NONLINEAR
  HullSums sums = HullSums(vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), 0.0, vec3(0.0));
#else
  HullSums sums = HullSums(vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec3(0.0));
#endif
  ivec2 across = hullCells(b, half_m) + 4;  // differences reach two cells further
#if WAVE
  across = min(across, waveCounts());
#endif
  // Clamped, because a non-finite position becomes an index.
  const vec2 middle = clamp((b.centre_m.xz + waveHalf_m()) / sim.wave_cell_m, vec2(-1e6), vec2(1e6));
  const ivec2 first = ivec2(floor(middle)) - across / 2;
  const BoatState before = drifted(b, -0.5 * sim.wave_dt_s);
  for (int k = int(gl_LocalInvocationID.x); k < across.x * across.y; k += int(kGroup))
    add(sums, b, before, half_m, peak_m, first + placeOf(k, across.x));
  return sums;
}

HullSums totalOf(HullSums share) {
  const uint own = gl_LocalInvocationID.x;
  share_lift[own] = share.lift;
  share_spread[own] = share.spread;
  share_water[own] = share.water;
  share_gradient[own] = share.gradient;
  share_push[own] = share.push;
#if NONLINEAR
  share_ground[own] = share.ground;
#endif
  memoryBarrierShared();
  barrier();
  if (own > 0u) return share;
  for (uint k = 1u; k < kGroup; ++k) {
    share.lift += share_lift[k];
    share.spread += share_spread[k];
    share.water += share_water[k];
    share.gradient += share_gradient[k];
    share.push += share_push[k];
#if NONLINEAR
    share.ground += share_ground[k];
#endif
  }
  return share;
}

/// Accelerations that depend on positions only.
struct Forces {
  vec3 along_mps2;  // forward, starboard, up
  vec2 tilt_ps2;
  float yaw_ps2;
};

void push(inout BoatState b, Forces forces, float duration_s) {
  b.speed_mps += duration_s * forces.along_mps2;
  b.tilt_rate += duration_s * forces.tilt_ps2;
  b.yaw_rate += duration_s * forces.yaw_ps2;
}

/// Speed relative to the water after some time of drag: u_t = -k |u| u ahead, w_t = -(c + |w|/B) w to the side.
vec2 slowed(BoatState b, vec2 relative_mps, float hold, float duration_s) {
  const float ahead = relative_mps.x / (1.0 + hold * duration_s * kDragPerLength / b.hull_m.x * abs(relative_mps.x));
  const float keep = exp(-hold * duration_s * kSwayDrag_per_s);
  const float side = relative_mps.y * keep / (1.0 + abs(relative_mps.y) * (1.0 - keep) / (kSwayDrag_per_s * b.hull_m.y));
  return vec2(ahead, side);
}

/// Changes the velocities by the forces of duration_s around the time of the sums.
void kick(inout BoatState b, HullSums sums, float duration_s) {
  const float g = sim.gravity_mps2;
  const float draught_m = b.hull_m.w;
  const float weight = max(sums.lift.x, 1e-6);
  const vec2 half_m = hullHalf(b);
  const float peak_m = hullPeak(b, half_m);
  const vec2 middle_m = sums.spread.xy / weight;
  const vec2 spread_m2 = sums.spread.zw / weight - middle_m * middle_m;
  // Mean submerged height [m]. A boat that is wholly on dry cells stands there.
  const float lift = sums.lift.x > 1e-6 ? sums.lift.y / weight : draught_m;
  const vec2 lever_m2 = sums.lift.zw / weight - lift * middle_m;
  // Sum of grad(w) (phi - mean of phi), and its moment. Its negative over the weight is the mean slope of phi.
  const vec3 pushed = sums.push - sums.gradient.xyz * (sums.gradient.w / weight);
  const float hold = clamp(2.0 * lift / draught_m, 0.0, 1.0);
  b.aloft = 1.0 - hold;

  // Velocities of the water are those half a wave step ago: extrapolated. A new boat has no earlier sample.
  const bool is_new = b.age_s <= sim.tick_s;
  const vec3 sampled_mps = sums.water.yzw / max(sums.water.x, 1e-6);
  const float ahead_of_sample = is_new ? 0.0 : 0.5 * sim.wave_dt_s / sim.tick_s;
  const vec3 water_mps = sampled_mps + ahead_of_sample * (sampled_mps - b.water_mps);
  b.water_mps = sampled_mps;

  // The mass is that of the whole hull; a boat that is not settled presses with a part of it.
  const float cell_m2 = sim.wave_cell_m * sim.wave_cell_m;
  const float pressing = hold > 0.0 ? peak_m * cell_m2 / (b.hull_m.x * b.hull_m.y * draught_m) : 0.0;
  const vec2 pushed_mps2 = g * pressing * inHull(b, pushed.xy);
  const float omega = sqrt(g / draught_m);
  // As in the implicit midpoint rule, so that a light hull is stable with any tick.
  const float restoring = g / draught_m / (1.0 + 0.25 * hold * omega * omega * duration_s * duration_s);
  const float throttle = b.control.x < 0.0 ? kReverseShare * b.control.x : b.control.x;
  const float thrust_mps2 = kDragPerLength / b.hull_m.x * b.full_speed_mps * b.full_speed_mps * throttle;
#if NONLINEAR
  const float aground = min(sums.ground / (weight * draught_m), 1.0);  // share of its weight
#else
  const float aground = 0.0;
#endif
  Forces forces;
  forces.along_mps2 = vec3(pushed_mps2.x + hold * (1.0 - aground) * thrust_mps2, pushed_mps2.y, restoring * (lift - draught_m));
  forces.tilt_ps2 = restoring * vec2(lever_m2.x, -lever_m2.y) / (spread_m2 + b.hull_m.z * b.hull_m.z / 12.0);
  forces.yaw_ps2 = g * pressing * pushed.z / (spread_m2.x + spread_m2.y);
  b.push_mps2 = pushed_mps2.x;

  push(b, forces, 0.5 * duration_s);
  const vec2 flow_mps = inHull(b, water_mps.xy);
  vec2 relative_mps = slowed(b, b.speed_mps.xy - flow_mps, hold, 0.5 * duration_s);
  const float turn = b.control.y * (relative_mps.x / (kTurnLengths * b.hull_m.x) + kWashYaw_per_s * abs(throttle));
  b.yaw_rate = mix(turn, b.yaw_rate, exp(-kYawRate_per_s * hold * duration_s));
  // The level under a moving hull changes by its slope, too.
  const float rise_mps = water_mps.z + dot(velocityOf(b), -pushed.xy / weight);
  b.speed_mps.z = mix(rise_mps, b.speed_mps.z, exp(-2.0 * kHeaveDamping * omega * duration_s * hold));
  b.tilt_rate *= exp(-2.0 * kTiltDamping * omega * duration_s * hold);
  relative_mps = slowed(b, relative_mps, hold, 0.5 * duration_s);
  b.speed_mps.xy = relative_mps + flow_mps;
#if NONLINEAR
  b.speed_mps.xy *= max(1.0 - kGroundFriction * g * aground * duration_s / max(length(b.speed_mps.xy), 1e-6), 0.0);
  b.yaw_rate *= exp(-kGroundYaw_per_s * aground * duration_s);
#endif
  push(b, forces, 0.5 * duration_s);
}

#if MOVED
/// Resistance of the moving water against a boat that is moved from outside, with the coefficients of the others, for the mass of
/// the water that it displaces. Also sets what others see of the boat.
void resist(BoatState b, HullSums sums, uint place) {
  const float weight = max(sums.lift.x, 1e-6);
  const float cell_m2 = sim.wave_cell_m * sim.wave_cell_m;
#if NONLINEAR
  const float lift = (sums.lift.y - sums.ground) / weight;
#else
  const float lift = sums.lift.y / weight;
#endif
  const float volume_m3 = hullFullness(b, hullHalf(b)) * lift * weight * cell_m2;
  const vec3 water_mps = sums.water.yzw / max(sums.water.x, 1e-6);
  const vec2 relative_mps = b.speed_mps.xy - inHull(b, water_mps.xy);
  const vec2 slowed_mps2 =
      -relative_mps * vec2(kDragPerLength / b.hull_m.x * abs(relative_mps.x), kSwayDrag_per_s + abs(relative_mps.y) / b.hull_m.y);
  const vec2 force = volume_m3 * (forwardOf(b.heading) * slowed_mps2.x + starboardOf(b.heading) * slowed_mps2.y);
  const vec2 middle_m = sums.spread.xy / weight;
  const vec2 spread_m2 = sums.spread.zw / weight - middle_m * middle_m;
  const uint out_at = place * HULL_FORCE_TEXELS;
  hull_forces[out_at + 4u] = vec4(force.x, 0.0, force.y, 1.0 / (weight * cell_m2));
  hull_forces[out_at + 5u] = vec4(0.0, 0.0, -volume_m3 * (spread_m2.x + spread_m2.y) * kYawRate_per_s * b.yaw_rate, 0.0);
  const uint at = place * BOAT_TEXELS;
  boats[at + 3u] = vec4(b.tilt_rate, vec2(0.0));
  boats[at + 5u] = vec4(b.full_speed_mps, 1.0 - clamp(2.0 * lift / b.hull_m.w, 0.0, 1.0), 1.0, 0.0);
  boats[at + 6u] = vec4(water_mps, 0.0);
}
#endif

void main() {
  const uint place = gl_WorkGroupID.x;
  vec4 t[BOAT_TEXELS];
  for (uint k = 0u; k < BOAT_TEXELS; ++k) t[k] = boats[place * BOAT_TEXELS + k];
  BoatState b = unpackBoat(t);
  if (b.age_s < 0.0) return;
  const vec2 half_m = hullHalf(b);
  const HullSums sums = totalOf(shareOf(b, half_m, hullPeak(b, half_m)));
  if (gl_LocalInvocationID.x > 0u) return;
#if MOVED
  if (b.is_moved) {
    resist(b, sums, place);
    return;
  }
#endif
  b.control = boat_control[place].xy;
  // A new boat's velocities are those of its launch, a tick ago and not half a tick.
  kick(b, sums, b.age_s <= sim.tick_s ? 1.5 * sim.tick_s : sim.tick_s);
  const uint at = place * BOAT_TEXELS;
  boats[at + 2u] = vec4(b.speed_mps, b.yaw_rate);
  boats[at + 3u] = vec4(b.tilt_rate, b.control);
  boats[at + 5u] = vec4(b.full_speed_mps, b.aloft, 0.0, 0.0);
  boats[at + 6u] = vec4(b.water_mps, b.push_mps2);
}
