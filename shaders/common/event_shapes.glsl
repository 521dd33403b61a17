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

/// A crest's integral at the two sides of the domain that it crosses, low and high: the same for all places.
vec2 crestEnds(EventUniform e) {
  return vec2(crestIntegral(-e.half_side_m - e.offset_m, e.front_m, e.back_m),
              crestIntegral(e.half_side_m - e.offset_m, e.front_m, e.back_m));
}

/// Displacement of a crest at a position, along its direction. `ends`: crestEnds(). A crest across the whole domain takes its
/// water evenly from all of it and moves none across the sides; a crest of finite width takes it from a trough behind.
float crestDisplacement(EventUniform e, vec2 place_m, vec2 ends) {
  const vec2 d = vec2(e.direction_x, e.direction_z);
  const float s = dot(place_m - vec2(e.x_m, e.z_m), d);
  const float own = crestIntegral(s - e.offset_m, e.front_m, e.back_m);
  if (e.lateral_m == 0.0) return own - mix(ends.x, ends.y, (s + e.half_side_m) / (2.0 * e.half_side_m));
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
  if (e.lateral_m == 0.0) return own - (ends.y - ends.x) / (2.0 * e.half_side_m);
  const float trough_m = e.front_m + e.back_m;
  const float behind = s - e.offset_m + 1.5 * trough_m;
  const float l = dot(place_m - vec2(e.x_m, e.z_m), vec2(-d.y, d.x)) / e.lateral_m;
  return exp(-l * l * l * l) * (own - 0.5 * crestShape(behind, trough_m, trough_m));
}

#endif
