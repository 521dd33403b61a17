// The shapes that effects press into the surface, without amplitude. Both keep the volume of the water.
#ifndef SPINDRIFT_EVENT_SHAPES
#define SPINDRIFT_EVENT_SHAPES

/// Splash: a disc pushed down and its rim up, (1 - q^2) exp(-q^2), q = r / radius: 1 at the centre, zero at the radius, zero
/// integral over the plane.
float splashShape(vec2 offset_m, float radius_m) {
  const float q2 = dot(offset_m, offset_m) / (radius_m * radius_m);
  return (1.0 - q2) * exp(-q2);
}

/// Crest: exp(-(s / half_width)^2) across the direction of travel.
float crestShape(float s_m, float half_width_m) {
  const float q = s_m / half_width_m;
  return exp(-q * q);
}

#endif
