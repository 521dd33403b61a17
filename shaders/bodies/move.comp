// One tick of every boat: one invocation per boat, all in one group.
// Reads SURFACE, SURFACE_FLOW, TERRAIN, BoatControls. Updates BOATS.
// Equations: buoyancy from HULL_COLUMNS columns of water under the hull. Each column is submerged up to the surface
// without the hull's own dent (elevation + own head); draught at rest = density ratio * height. Heave, pitch and roll
// are damped oscillators about it, omega^2 = g/draught. Thrust balances quadratic drag, relative to the moving water,
// at full speed; the rudder turns a moving boat on a circle of about two lengths; the slope of the surface accelerates
// it. A boat thrown up by waves falls freely: all forces but buoyancy are multiplied by min(1, 2 s), s being the share
// of its weight that the water carries. Contacts: three circles along each hull against other boats, obstacles, shallow
// ground and sides. Each boat moves by half of the overlap and loses its approaching speed.
// Invariant: boats stay inside the domain and out of obstacles; nothing depends on the order of invocations.
#include "bodies/boat.glsl"
#include "wave/wave_cell.glsl"
#if WAVE
#include "bodies/surface_sample.glsl"
#else
// Without a wave, boats float at the resting level in still water.
vec4 surfaceUnder(vec2 xz, out vec2 flow_mps) {
  flow_mps = vec2(0.0);
  return vec4(0.0);
}
#endif
#if VARIED
#include "common/terrain.glsl"
#endif

layout(local_size_x = MAX_BOATS) in;

layout(std430, binding = BOATS) restrict buffer Boats { vec4 boats[]; };

const int kAlong = 5;
const int kAcross = 3;
const float kHeaveDamping = 0.3;      // of critical
const float kTiltDamping = 0.25;      // of critical
const float kDragPerLength = 0.35;    // quadratic drag over the length: full speed within a few lengths
const float kReverseShare = 0.4;      // thrust astern over thrust ahead
const float kTurnLengths = 1.6;       // radius of the tightest circle over the length
const float kYawRate_per_s = 3.0;     // rate at which the boat follows its rudder
const float kWashYaw_per_s = 0.25;    // turning by the propeller's wash at standstill
const float kSwayDrag_per_s = 2.5;
const float kBounce = 0.3;
const float kGroundingDepth = 1.1;    // depth over draught at which a boat runs aground

BoatState boatAt(uint place) {
  vec4 t[BOAT_TEXELS];
  for (uint k = 0u; k < BOAT_TEXELS; ++k) t[k] = boats[place * BOAT_TEXELS + k];
  return unpackBoat(t);
}

/// Centre of the k-th of three circles along the hull, k = -1, 0, 1; their radius is half the beam.
vec2 circleOf(BoatState b, int k) {
  return b.centre_m.xz + forwardOf(b.heading) * (float(k) * 0.5 * max(b.hull_m.x - b.hull_m.y, 0.0));
}

vec2 velocityOf(BoatState b) {
  return forwardOf(b.heading) * b.speed_mps.x + starboardOf(b.heading) * b.speed_mps.y;
}

/// Pushes the boat out of a contact at `normal` by depth_m; the speed against it is weakly reversed.
void pushBack(inout vec2 shift_m, inout vec2 velocity_mps, vec2 normal, float depth_m, float approach_mps) {
  shift_m += normal * depth_m;
  velocity_mps += normal * max(approach_mps, 0.0) * (1.0 + kBounce);
}

/// Heave, pitch and roll. Returns the slope of the water along the hull, without the hull's own dent.
float floatOnWater(inout BoatState b) {
  const float g = sim.gravity_mps2;
  const float draught_m = b.hull_m.w;
  float lift = 0.0;
  vec2 lever = vec2(0.0);
  float rise_mps = 0.0;
  vec2 slope = vec2(0.0);  // sums of level * along and along^2
  for (int k = 0; k < kAlong; ++k) {
    for (int j = 0; j < kAcross; ++j) {
      const vec2 at_m = b.hull_m.xy * vec2((float(k) + 0.5) / float(kAlong) - 0.5, (float(j) + 0.5) / float(kAcross) - 0.5);
      const vec2 place_m = b.centre_m.xz + forwardOf(b.heading) * at_m.x + starboardOf(b.heading) * at_m.y;
      vec2 flow_mps;
      const vec4 s = surfaceUnder(place_m, flow_mps);
      const float keel_m = b.centre_m.y - 0.5 * b.hull_m.z + at_m.x * b.tilt.x - at_m.y * b.tilt.y;
#if WAVE
      const float level_m = s.x + hullHead(b, at_m);
#else
      const float level_m = s.x;
#endif
      const float submerged_m = clamp(level_m - keel_m, 0.0, b.hull_m.z);
      slope += vec2(level_m, at_m.x) * at_m.x;
      lift += submerged_m;
      lever += submerged_m * at_m;
      rise_mps += s.y;
    }
  }
  const float columns = float(kAlong * kAcross);
  const float hold = clamp(2.0 * lift / (columns * draught_m), 0.0, 1.0);
  b.aloft = 1.0 - hold;
  const float omega = sqrt(g / draught_m);
  const vec2 inertia = 12.0 / (b.hull_m.xy * b.hull_m.xy + b.hull_m.z * b.hull_m.z);
  const float dt_s = sim.tick_s;
  b.speed_mps.z += dt_s * g * (lift / (columns * draught_m) - 1.0);
  b.speed_mps.z = mix(rise_mps / columns, b.speed_mps.z, exp(-2.0 * kHeaveDamping * omega * dt_s * hold));
  b.tilt_rate += dt_s * g / (columns * draught_m) * inertia * vec2(lever.x, -lever.y);
  b.tilt_rate *= exp(-2.0 * kTiltDamping * omega * dt_s * hold);
  b.tilt = clamp(b.tilt + dt_s * b.tilt_rate, vec2(-0.6), vec2(0.6));
  b.centre_m.y += dt_s * b.speed_mps.z;
  return slope.x / slope.y;
}

void drive(inout BoatState b, float slope) {
  const float dt_s = sim.tick_s;
  const float hold = 1.0 - b.aloft;
  vec2 flow_mps;
  surfaceUnder(b.centre_m.xz, flow_mps);
  const vec2 f = forwardOf(b.heading);
  const vec2 water_mps = vec2(dot(flow_mps, f), dot(flow_mps, starboardOf(b.heading)));
  const float throttle = b.control.x < 0.0 ? kReverseShare * b.control.x : b.control.x;
  const float drag_pm = kDragPerLength / b.hull_m.x;
  vec2 relative_mps = b.speed_mps.xy - water_mps;
  relative_mps.x += hold * dt_s * (drag_pm * b.full_speed_mps * b.full_speed_mps * throttle - sim.gravity_mps2 * slope);
  relative_mps.x /= 1.0 + hold * dt_s * drag_pm * abs(relative_mps.x);
  relative_mps.y *= exp(-hold * dt_s * (kSwayDrag_per_s + abs(relative_mps.y) / b.hull_m.y));
  b.speed_mps.xy = relative_mps + water_mps;
  const float yaw = b.control.y * (relative_mps.x / (kTurnLengths * b.hull_m.x) + kWashYaw_per_s * abs(throttle));
  b.yaw_rate = mix(yaw, b.yaw_rate, exp(-kYawRate_per_s * hold * dt_s));
  // The heading turns, the velocity does not; sway drag then aligns the velocity.
  const vec2 velocity_mps = velocityOf(b);
  b.heading += dt_s * b.yaw_rate;
  if (abs(b.heading) > 3.14159265) b.heading -= 6.2831853 * sign(b.heading);
  b.speed_mps.xy = vec2(dot(velocity_mps, forwardOf(b.heading)), dot(velocity_mps, starboardOf(b.heading)));
  b.centre_m.xz += dt_s * velocity_mps;
}

/// Boats before this tick: all invocations read the same state.
void meetBoats(BoatState b, uint own, inout vec2 shift_m, inout vec2 velocity_mps) {
  for (uint other = 0u; other < boat_place_count; ++other) {
    const BoatState o = boatAt(other);
    if (other == own || o.age_s < 0.0) continue;
    float deepest_m = 0.0;
    vec2 normal = vec2(0.0);
    for (int k = -1; k <= 1; ++k) {
      for (int j = -1; j <= 1; ++j) {
        const vec2 d = acrossSides(circleOf(b, k) - circleOf(o, j));
        const float distance_m = length(d);
        const float overlap_m = 0.5 * (b.hull_m.y + o.hull_m.y) - distance_m;
        if (overlap_m > deepest_m) {
          deepest_m = overlap_m;
          // Two boats at the same place separate by their order.
          normal = distance_m > 1e-4 ? d / distance_m : vec2(own < other ? 1.0 : -1.0, 0.0);
        }
      }
    }
    if (deepest_m <= 0.0) continue;
    const float share = o.hull_m.x * o.hull_m.y / (b.hull_m.x * b.hull_m.y + o.hull_m.x * o.hull_m.y);
    pushBack(shift_m, velocity_mps, normal, share * deepest_m, share * dot(velocityOf(o) - velocityOf(b), normal));
  }
}

#if VARIED
void meetGround(BoatState b, inout vec2 shift_m, inout vec2 velocity_mps) {
  for (int k = -1; k <= 1; ++k) {
    const vec2 p = circleOf(b, k);
    const vec4 t = terrainAt(p);
    const float overlap_m = 0.5 * b.hull_m.y - t.x;
    if (overlap_m > 0.0) pushBack(shift_m, velocity_mps, t.yz, overlap_m, -dot(velocity_mps, t.yz));
    // Aground: moves slowly toward deeper water, and not further onto the ground.
    const float missing_m = kGroundingDepth * b.hull_m.w - t.w;
    if (missing_m > 0.0 && t.x > 0.0) {
      const float step_m = 2.0 * sim.wave_cell_m;
      const vec2 deeper = vec2(terrainAt(p + vec2(step_m, 0.0)).w - terrainAt(p - vec2(step_m, 0.0)).w,
                               terrainAt(p + vec2(0.0, step_m)).w - terrainAt(p - vec2(0.0, step_m)).w);
      const vec2 normal = deeper / max(length(deeper), 1e-6);
      pushBack(shift_m, velocity_mps, normal, min(missing_m, 0.5 * sim.tick_s * b.hull_m.x), -dot(velocity_mps, normal));
    }
  }
}
#endif

void meetSides(BoatState b, inout vec2 shift_m, inout vec2 velocity_mps) {
#if WAVE
  const vec2 inside_m = vec2(0.5 * sim.wave_side_m - 0.5 * b.hull_m.y);
#else
  const vec2 inside_m = vec2(sim.max_x_m, sim.max_z_m) - 0.5 * b.hull_m.y;
#endif
  for (int k = -1; k <= 1; ++k) {
    const vec2 over_m = circleOf(b, k) + shift_m;
    const vec2 beyond_m = clamp(over_m, -inside_m, inside_m) - over_m;
#if !WAVE_PERIODIC_X
    if (beyond_m.x != 0.0) pushBack(shift_m, velocity_mps, vec2(sign(beyond_m.x), 0.0), abs(beyond_m.x), -sign(beyond_m.x) * velocity_mps.x);
#endif
#if !WAVE_PERIODIC_Z
    if (beyond_m.y != 0.0) pushBack(shift_m, velocity_mps, vec2(0.0, sign(beyond_m.y)), abs(beyond_m.y), -sign(beyond_m.y) * velocity_mps.y);
#endif
  }
}

void main() {
  const uint own = gl_LocalInvocationID.x;
  BoatState b = boatAt(own);
  const bool is_here = own < boat_place_count && b.age_s >= 0.0;
  if (is_here) {
    b.control = boat_control[own].xy;
    b.age_s += sim.tick_s;
    const float slope = floatOnWater(b);
    drive(b, slope);
    vec2 shift_m = vec2(0.0);
    vec2 velocity_mps = velocityOf(b);
    meetBoats(b, own, shift_m, velocity_mps);
#if VARIED
    meetGround(b, shift_m, velocity_mps);
#endif
    meetSides(b, shift_m, velocity_mps);
    b.centre_m.xz = acrossSides(b.centre_m.xz + shift_m);
    b.speed_mps.xy = vec2(dot(velocity_mps, forwardOf(b.heading)), dot(velocity_mps, starboardOf(b.heading)));
  }
  // Barrier: all invocations have read the boats before any writes them.
  memoryBarrierBuffer();
  barrier();
  if (!is_here) return;
  const uint at = own * BOAT_TEXELS;
  boats[at] = vec4(b.centre_m, b.heading);
  boats[at + 1u] = vec4(b.tilt, b.age_s, b.id);
  boats[at + 2u] = vec4(b.speed_mps, b.yaw_rate);
  boats[at + 3u] = vec4(b.tilt_rate, b.control);
  boats[at + 5u] = vec4(b.full_speed_mps, b.aloft, 0.0, 0.0);
}
