// What the particles add up to along the pixel's ray. Blending adds red to blue; alpha becomes 1 - (1 - a) (1 - b).
// Writes thickness [m], weight, weight of particles among others, coverage. A particle's thickness over its ellipse integrates to its volume, (2 r)^3.
#include <fluid_ellipse>

uniform float u_radius_m;
layout(location = 0) out vec4 sum;

void main() {
  float inside = 1.0 - outline2();
  if (inside <= 0.0) discard;
  float thickness_m = 5.093 * u_radius_m * u_radius_m * u_radius_m / (v_radius_m * v_radius_m * v_flight.z) * inside;
  float weight = inside * inside;
  // A single drop is dense in its middle; neighbours melt into each other.
  float covered = mix(min(1.6 * inside, 1.0), weight, v_foam_bulk.y);
  sum = vec4(thickness_m, weight, v_foam_bulk.y * weight, covered * v_strength);
}
