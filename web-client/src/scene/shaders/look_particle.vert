// One point per particle; its square covers the particle's sphere.
// OF_SPEED: v_value is the speed [m/s]; OF_DENSITY: density over rest density; neither: 1 white to 0 coloured, by density and foam.
#include <fluid_words>

uniform mat4 viewMatrix;
uniform mat4 projectionMatrix;
uniform vec2 u_target_px;

flat out float v_ahead_m;  // distance of the centre along the view's axis
flat out float v_value;

void main() {
  Particle particle = unpackParticle();
  float density = 0.5 + 0.6 * particle.density;
#if defined(OF_SPEED)
  v_value = length(particle.velocity_mps);
#elif defined(OF_DENSITY)
  v_value = density;
#else
  v_value = max(smoothstep(0.95, 0.65, density), particle.foam);
#endif
  vec3 center_m = (viewMatrix * vec4(particle.center_m, 1.0)).xyz;
  v_ahead_m = -center_m.z;
  if (v_ahead_m < 1.5 * u_radius_m) {
    gl_Position = vec4(0.0, 0.0, 2.0, 1.0);
    gl_PointSize = 1.0;
    return;
  }
  gl_Position = projectionMatrix * vec4(center_m, 1.0);
  gl_PointSize = max(u_radius_m * projectionMatrix[1][1] * u_target_px.y / v_ahead_m, 2.0);
}
