// The surface of a floater: its signed distance, and the points at which it touches others.
#ifndef SPINDRIFT_FLOATER_SHAPE
#define SPINDRIFT_FLOATER_SHAPE

#include "bodies/floater.glsl"

/// Signed distance of a rectangle, with its gradient.
vec3 rectangle(vec2 p, vec2 half_m) {
  const vec2 q = abs(p) - half_m;
  const vec2 way = vec2(p.x < 0.0 ? -1.0 : 1.0, p.y < 0.0 ? -1.0 : 1.0);
  if (max(q.x, q.y) <= 0.0) return q.x > q.y ? vec3(way.x, 0.0, q.x) : vec3(0.0, way.y, q.y);
  const vec2 beyond = max(q, 0.0);
  const float distance_m = length(beyond);
  return vec3(way * beyond / max(distance_m, 1e-9), distance_m);
}

/// The same of a box.
vec4 boxDistance(vec3 p, vec3 half_m) {
  const vec3 q = abs(p) - half_m;
  const vec3 way = vec3(p.x < 0.0 ? -1.0 : 1.0, p.y < 0.0 ? -1.0 : 1.0, p.z < 0.0 ? -1.0 : 1.0);
  const float deepest = max(q.x, max(q.y, q.z));
  if (deepest <= 0.0) {
    const vec3 face = q.x == deepest ? vec3(1.0, 0.0, 0.0) : (q.y == deepest ? vec3(0.0, 1.0, 0.0) : vec3(0.0, 0.0, 1.0));
    return vec4(way * face, deepest);
  }
  const vec3 beyond = max(q, 0.0);
  const float distance_m = length(beyond);
  return vec4(way * beyond / max(distance_m, 1e-9), distance_m);
}

/// Outward normal, and signed distance [m], of the surface at a position from the centre of mass, both in the water's axes.
vec4 surfaceOf(Floater b, vec3 from_centre_m) {
  const vec3 p = rotatedBack(b.rotation, from_centre_m) + vec3(0.0, b.ballast_m, 0.0);
  vec4 local;
  if (b.shape == FLOATER_SPHERE) {
    const float r = length(p);
    local = vec4(r > 1e-6 ? p / r : vec3(0.0, 1.0, 0.0), r - b.half_m.x);
  } else if (b.shape == FLOATER_BOX) {
    local = boxDistance(p, b.half_m);
  } else if (b.shape == FLOATER_CYLINDER_X) {
    const float r = length(p.yz);
    const vec3 d = rectangle(vec2(p.x, r), b.half_m.xy);
    local = vec4(d.x, d.y * (r > 1e-6 ? p.yz / r : vec2(1.0, 0.0)), d.z);
  } else {
    const float r = length(p.xz);
    const vec3 d = rectangle(vec2(p.y, r), b.half_m.yx);
    const vec2 outward = r > 1e-6 ? p.xz / r : vec2(1.0, 0.0);
    local = vec4(d.y * outward.x, d.x, d.y * outward.y, d.z);
  }
  return vec4(rotated(b.rotation, local.xyz), local.w);
}

/// How many points a floater touches others with; at most FLOATER_POINTS.
int pointCount(Floater b) { return b.shape == FLOATER_SPHERE ? 1 : FLOATER_POINTS; }
/// The radius around them. [m]
float pointRadius(Floater b) { return b.shape == FLOATER_SPHERE ? b.half_m.x : 0.0; }

/// The k-th point, from the centre of mass in the water's axes [m]. Of a box the corners and the middles of its edges along x and z; of
/// a cylinder 6 on each rim and 4 half way between.
vec3 pointOf(Floater b, int k) {
  vec3 p = vec3(0.0);
  if (b.shape == FLOATER_BOX) {
    p = vec3((k & 1) * 2 - 1, ((k >> 1) & 1) * 2 - 1, ((k >> 2) & 1) * 2 - 1);
    if (k >= 12) p = vec3(p.x, p.y, 0.0);
    else if (k >= 8) p = vec3(0.0, p.y, p.x);
    p *= b.half_m;
  } else if (b.shape != FLOATER_SPHERE) {
    const float angle = k < 12 ? 1.04719755 * float(k) : 1.57079633 * float(k);
    const vec3 q = vec3(k < 6 ? -1.0 : (k < 12 ? 1.0 : 0.0), cos(angle), sin(angle));
    p = (b.shape == FLOATER_CYLINDER_X ? q : vec3(q.y, q.x, q.z)) * b.half_m;
  }
  return rotated(b.rotation, p - vec3(0.0, b.ballast_m, 0.0));
}

#endif
