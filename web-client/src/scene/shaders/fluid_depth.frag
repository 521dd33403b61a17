// The particles' nearest surface as seen by the camera.
// Writes 1 / distance along the view's axis [1/m], which is linear in screen coordinates on every plane, and the particle's foam.
#include <fluid_sizes>
#include <fluid_ellipse>

uniform mat4 projectionMatrix;
uniform float u_radius_m;
layout(location = 0) out vec2 front;

void main() {
  float off2 = outline2();
  if (off2 >= 1.0) discard;
  // The widened sphere is moved back by what it is wider, so that the surface stays where the water is.
  float ahead_m = v_ahead_m - v_radius_m * sqrt(1.0 - off2) + max(v_radius_m - 1.1 * u_radius_m, 0.0);
  front = vec2(1.0 / ahead_m, v_foam_bulk.x);
  gl_FragDepth = clamp(0.5 * (projectionMatrix[3][2] / ahead_m - projectionMatrix[2][2]) + 0.5, 0.0, 1.0);
}
