// Effects as displacements of water: a vector field V in m^2 whose divergence is the change of elevation. Moving water
// through faces, instead of adding it to cells, conserves the volume to the last unit, walls included.
#ifndef SPINDRIFT_EVENT_SHAPES
#define SPINDRIFT_EVENT_SHAPES

#include "shared/event_uniforms.h"

/// Splash: V = r/2 exp(-q^2), q = |r| / radius, zero beyond SPLASH_REACH radii. div V = (1 - q^2) exp(-q^2): 1 in the
/// centre, negative (a rim) beyond the radius.
vec2 splashDisplacement(vec2 r_m, float radius_m) {
  const float q2 = dot(r_m, r_m) / (radius_m * radius_m);
  return q2 < SPLASH_REACH * SPLASH_REACH ? 0.5 * r_m * exp(-q2) : vec2(0.0);
}

/// The divergence of splashDisplacement().
float splashElevation(vec2 r_m, float radius_m) {
  const float q2 = dot(r_m, r_m) / (radius_m * radius_m);
  return (1.0 - q2) * exp(-q2);
}

/// Crest: sech^2(s / width), with different widths of front and back. s increases in the direction of travel.
float crestShape(float s_m, float front_m, float back_m) {
  const float u = 1.0 / cosh(clamp(s_m / (s_m > 0.0 ? front_m : back_m), -12.0, 12.0));
  return u * u;
}

/// Integral of crestShape() from the crest. [m]
float crestIntegral(float s_m, float front_m, float back_m) {
  const float width_m = s_m > 0.0 ? front_m : back_m;
  return width_m * tanh(clamp(s_m / width_m, -12.0, 12.0));
}

/// A crest's integral at the two sides of the domain that it crosses, low and high: the same for all positions.
vec2 crestEnds(EventUniform e) {
  return vec2(crestIntegral(-e.half_side_m - e.offset_m, e.front_m, e.back_m),
              crestIntegral(e.half_side_m - e.offset_m, e.front_m, e.back_m));
}

// A crest across the whole domain takes its water evenly from all of it. Where waves disperse, it takes it from between itself
// and the side that it comes from, and little beside the crest: obstacles ahead would dam up what flows past them, and short
// waves are slow.
#if DISPERSE
#define RISE_SHARE 0.3  // of that way, from the crest on

/// Position on the way from the crest (0) to the side behind it (1).
float behindCrest(EventUniform e, float s) { return clamp((e.offset_m - s) / (e.offset_m + e.half_side_m), 0.0, 1.0); }
#endif

/// Share of that water that comes from positions up to s along the crest's direction.
float takenShare(EventUniform e, float s) {
#if DISPERSE
  const float u = behindCrest(e, s);
  const float t = min(u / RISE_SHARE, 1.0);
  return 1.0 - (RISE_SHARE * t * t * t * (1.0 - 0.5 * t) + max(u - RISE_SHARE, 0.0)) / (1.0 - 0.5 * RISE_SHARE);
#else
  return (s + e.half_side_m) / (2.0 * e.half_side_m);
#endif
}

/// What the surface falls by at s, for a crest of this volume (per width) [m].
float takenElevation(EventUniform e, float s, float volume_m) {
#if DISPERSE
  const float t = min(behindCrest(e, s) / RISE_SHARE, 1.0);
  return volume_m * t * t * (3.0 - 2.0 * t) / ((1.0 - 0.5 * RISE_SHARE) * (e.offset_m + e.half_side_m));
#else
  return volume_m / (2.0 * e.half_side_m);
#endif
}

/// Displacement of a crest at a position, along its direction. `ends`: crestEnds(). A crest across the whole domain moves no
/// water across the sides; a crest of finite width takes its water from a trough behind.
float crestDisplacement(EventUniform e, vec2 place_m, vec2 ends) {
  const vec2 d = vec2(e.direction_x, e.direction_z);
  const float s = dot(place_m - vec2(e.x_m, e.z_m), d);
  const float own = crestIntegral(s - e.offset_m, e.front_m, e.back_m);
  if (e.lateral_m == 0.0) return own - mix(ends.x, ends.y, takenShare(e, s));
  const float trough_m = e.front_m + e.back_m;
  const float behind = s - e.offset_m + 1.5 * trough_m;
  const float l = dot(place_m - vec2(e.x_m, e.z_m), vec2(-d.y, d.x)) / e.lateral_m;
  return exp(-l * l * l * l) * (own - 0.5 * crestIntegral(behind, trough_m, trough_m) - 0.5 * (e.front_m - e.back_m));
}

/// Change of elevation; the flow of the travelling crest follows from it.
float crestElevation(EventUniform e, vec2 place_m, vec2 ends) {
  const vec2 d = vec2(e.direction_x, e.direction_z);
  const float s = dot(place_m - vec2(e.x_m, e.z_m), d);
  const float own = crestShape(s - e.offset_m, e.front_m, e.back_m);
  if (e.lateral_m == 0.0) return own - takenElevation(e, s, ends.y - ends.x);
  const float trough_m = e.front_m + e.back_m;
  const float behind = s - e.offset_m + 1.5 * trough_m;
  const float l = dot(place_m - vec2(e.x_m, e.z_m), vec2(-d.y, d.x)) / e.lateral_m;
  return exp(-l * l * l * l) * (own - 0.5 * crestShape(behind, trough_m, trough_m));
}

/// Share of the flow that a calmed disc takes at a distance from its middle.
float calmDrag(CalmUniform calm, vec2 away_m) {
  return calm.drag_ratio * clamp(1.0 - dot(away_m, away_m) / (calm.radius_m * calm.radius_m), 0.0, 1.0);
}

#endif
