// Include: a particle's colour. Deep blue where dense, light cyan where thin, white foam; darker in the water.
const vec3 kAmbientBelow = vec3(0.20, 0.28, 0.36);
const vec3 kAmbientAbove = vec3(0.52, 0.66, 0.84);

// Spray over a surface: a particle stands for many droplets and is drawn smaller than its volume, so that it does not look like a bead.
const float kSprayRadius = 0.62;

float outOfWater(float above_m, float radius_m) { return smoothstep(0.15, 1.0, above_m / radius_m); }

// Bubbles under water are dimmer than foam on it.
float foamShare(float foam, float out_of_water) { return smoothstep(0.06, 0.75, foam) * mix(0.5, 1.0, out_of_water); }

vec3 particleAlbedo(float tint, float foam_share, float out_of_water) {
  float dense = smoothstep(0.30, 0.92, tint);
  vec3 water = mix(vec3(0.24, 0.74, 0.86), vec3(0.010, 0.16, 0.38), dense);
  // In the water a sphere has nearly the colour of the water around it.
  water = mix(mix(water, vec3(0.035, 0.33, 0.46), 0.6), water, out_of_water);
  return mix(water, vec3(0.95, 0.98, 1.0), foam_share);
}

// Share of the light that reaches a particle at height `y_m`; 1 in the open.
float lightReaching(float y_m, float depth_m, float out_of_water) {
  return mix(1.0, 0.6, clamp(-y_m / depth_m, 0.0, 1.0)) * mix(0.72, 1.0, out_of_water);
}
