// Include in water.frag: waves finer than a pixel, as slopes that a pixel sees (Bruneton et al. 2010; Dupuy & Bruneton 2012 filter them the
// same way), and the sunlight that they mirror. Part of their variance is drawn as waves of a few pixels, whatever the distance: so glints
// become finer with it. The rest widens each glint. Needs ripples.glsl, u_slope_variances.

// Waves of this many texels of the ripples' tile are about as long as the shortest.
const float kTexelsPerPixel = 2.4;

// Slopes of variance 1 (both axes together) of waves a few pixels long.
vec2 pixelSlopes(vec2 at) {
  // A pixel of distant water is much longer than wide: its mean side, or all waves would be dashes.
  float pixel_m = max(sqrt(length(dFdx(at)) * length(dFdy(at))), 1e-4);
  float level = log2(pixel_m * float(textureSize(u_ripples, 0).x) / (kTexelsPerPixel * u_tiles_m.y));
  float low = floor(level);
  float share = level - low;
  vec2 scaled = at * exp2(-low) / u_tiles_m.y;
  // Two sizes, of independent waves: the squares of their shares add up to 1.
  vec2 finer = textureLod(u_ripples, kTurnedRipples * scaled + 0.37 * low, 0.0).gb * kTurnedRipples;
  low += 1.0;
  scaled = 0.5 * scaled;
  vec2 wider = textureLod(u_ripples, kTurnedRipples * scaled + 0.37 * low, 0.0).gb * kTurnedRipples;
  return (finer * (1.0 - share) + wider * share) * inversesqrt(max(u_slope_variances.y * (1.0 - 2.0 * share + 2.0 * share * share), 1e-6));
}

// Share of the variance that is drawn as waves of a few pixels: the more, the smaller and sparser the glints.
#ifdef OPEN_SEA
const float kDrawnShare = 0.9;
#else
const float kDrawnShare = 0.8;
#endif
// The finest waves are seen as an even gleam around the glints.
const float kGleam = 0.10;

// Share of the sunlight that slopes of this variance around `slopes` mirror, by the density of those that do (Cox & Munk 1954).
// `missing`: the slopes that mirror the sun.
float mirroredShare(vec2 missing, float variance) {
  float off = dot(missing, missing) / variance;
  return off > 30.0 ? 0.0 : exp(-off) / variance;
}

// Sunlight that a surface mirrors toward the eye whose mean slopes are these, and whose waves within a pixel have this variance.
vec3 mirroredSun(vec3 ray, vec2 slopes, vec2 pixel_slopes, float variance, float facing) {
  vec3 halfway = normalize(u_sun_direction - ray);
  vec2 missing = halfway.xz / max(halfway.y, 0.05) + slopes;
  float gleam = mirroredShare(missing, variance);
  float glints = mirroredShare(missing + sqrt(kDrawnShare * variance) * pixel_slopes, (1.0 - kDrawnShare) * variance + 4e-5);
  float steep = halfway.y * halfway.y;
  vec2 share = vec2(glints, gleam) * (waterFresnel(max(-dot(halfway, ray), 0.0)) / (4.0 * max(facing, 0.06) * steep * steep));
  // Brighter than white is only white: glints keep a middle and a rim.
  share /= 1.0 + vec2(1.6, 2.4) * share;
  return u_sun_light * (1.25 * mix(share.x, share.y, kGleam));
}
