// State of a floater in registers, its shape and its mass.
#ifndef SPINDRIFT_FLOATER
#define SPINDRIFT_FLOATER

#include "shared/bindings.h"
#include "shared/floaters.h"
#include "shared/sim_uniforms.h"
#include "wave/wave_cell.glsl"

struct Floater {
  vec3 centre_m;      // of mass
  float age_s;
  vec4 rotation;
  vec3 velocity_mps;
  float id;
  vec3 spin_radps;
  float dent;
  vec3 half_m;
  int shape;
  float density_ratio;
  float ballast_m;
  vec4 hold;
  vec3 acceleration_mps2;
  float turn_radps;
  vec3 spin_up_radps2;
};

Floater unpackFloater(vec4 t[FLOATER_TEXELS]) {
  return Floater(t[0].xyz, t[0].w, t[1], t[2].xyz, t[2].w, t[3].xyz, t[3].w, t[4].xyz, int(t[4].w) & 7, t[5].x, t[5].y, t[6],
                 t[7].xyz, t[7].w, t[8].xyz);
}

vec3 rotated(vec4 q, vec3 v) { return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v); }
vec3 rotatedBack(vec4 q, vec3 v) { return rotated(vec4(-q.xyz, q.w), v); }

/// Rotation after turning with an angular velocity for some time; exact for a constant one.
vec4 turned(vec4 q, vec3 spin_radps, float duration_s) {
  const float rate = length(spin_radps);
  const float angle = 0.5 * rate * duration_s;
  const vec3 axis = rate > 1e-6 ? spin_radps * (sin(angle) / rate) : 0.5 * duration_s * spin_radps;
  const vec4 p = vec4(axis, cos(angle));
  return normalize(vec4(p.w * q.xyz + q.w * p.xyz + cross(p.xyz, q.xyz), p.w * q.w - dot(p.xyz, q.xyz)));
}

/// [m^3]
float volumeOf(Floater b) {
  const vec3 h = b.half_m;
  if (b.shape == FLOATER_SPHERE) return 4.18879 * h.x * h.x * h.x;
  return (b.shape == FLOATER_BOX ? 8.0 : 6.2831853) * h.x * h.y * h.z;
}

/// Moments of inertia about its axes over its mass. [m^2]
vec3 inertiaOf(Floater b) {
  const vec3 h2 = b.half_m * b.half_m;
  if (b.shape == FLOATER_SPHERE) return vec3(0.4 * h2.x);
  const vec3 share = b.shape == FLOATER_BOX ? vec3(1.0 / 3.0)
                                            : (b.shape == FLOATER_CYLINDER_X ? vec3(1.0 / 3.0, 0.25, 0.25) : vec3(0.25, 1.0 / 3.0, 0.25));
  const vec3 m = share * h2;
  return vec3(m.y + m.z, m.x + m.z, m.x + m.y);
}

/// The angular velocity that an angular momentum over the mass gives. [m^2/s] -> [rad/s]
vec3 spinOf(Floater b, vec3 momentum) { return rotated(b.rotation, rotatedBack(b.rotation, momentum) / inertiaOf(b)); }
vec3 angularMomentumOf(Floater b) { return rotated(b.rotation, rotatedBack(b.rotation, b.spin_radps) * inertiaOf(b)); }

/// The middle of its shape. [m]
vec3 middleOf(Floater b) { return b.centre_m - rotated(b.rotation, vec3(0.0, b.ballast_m, 0.0)); }

/// Radius of a sphere about the centre of mass that contains it. [m]
float reachOf(Floater b) { return (b.shape == FLOATER_SPHERE ? b.half_m.x : length(b.half_m)) + abs(b.ballast_m); }

vec3 limited(vec3 v, float highest) { return v * min(1.0, highest / max(length(v), 1e-9)); }

/// The floater after it has moved with its velocities for some time: its angular momentum stays, whatever its shape.
Floater drifted(Floater b, float duration_s) {
  const vec3 momentum = angularMomentumOf(b);
  b.centre_m += duration_s * b.velocity_mps;
  b.centre_m.xz = acrossSides(b.centre_m.xz);
  b.rotation = turned(b.rotation, b.spin_radps, duration_s);
  b.spin_radps = spinOf(b, momentum);
  return b;
}

#endif
