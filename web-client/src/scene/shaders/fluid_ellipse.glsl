// Include: the position of this pixel in the particle's ellipse.
flat in float v_ahead_m;
flat in float v_radius_m;
flat in vec3 v_flight;
flat in vec2 v_foam_bulk;
flat in float v_strength;

// Returns the squared distance from the centre: 0, and 1 on the outline.
float outline2() {
  vec2 at = (gl_PointCoord * 2.0 - 1.0) * vec2(1.0, -1.0) * v_flight.z;
  vec2 local = vec2(dot(at, v_flight.xy) / v_flight.z, dot(at, vec2(-v_flight.y, v_flight.x)));
  return dot(local, local);
}
