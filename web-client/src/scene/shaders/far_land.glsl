// Include: hills far beyond the sea. After u_ambient_up.
const float kFarLandTop = 0.045;  // no far land is seen in higher directions

// Height of a far ridge over the horizon in a direction, rad: hills with gaps of open sea.
float ridge(float azimuth_rad, float seed) {
  float hills = 0.55 + 0.25 * sin(7.0 * azimuth_rad + seed) + 0.13 * sin(17.0 * azimuth_rad + 2.3 * seed) + 0.07 * sin(41.0 * azimuth_rad + 5.1 * seed);
  return hills * smoothstep(0.0, 0.9, sin(3.0 * azimuth_rad + seed) + 0.35 * sin(5.0 * azimuth_rad - seed));
}

// Land far beyond the sea, in the haze: the farther ridge is paler. `soft`: half the width of its edge.
vec3 withFarLand(vec3 sky, vec3 direction, float soft) {
  float azimuth_rad = atan(direction.z, direction.x);
  vec3 land = u_ambient_up * vec3(0.17, 0.22, 0.25);
  float farther = 0.034 * ridge(azimuth_rad, 1.3), nearer = 0.017 * ridge(azimuth_rad, 4.4);
  sky = mix(sky, land, 0.32 * (1.0 - smoothstep(farther - soft, farther + soft, direction.y)) * step(1e-4, farther));
  return mix(sky, land, 0.55 * (1.0 - smoothstep(nearer - soft, nearer + soft, direction.y)) * step(1e-4, nearer));
}
