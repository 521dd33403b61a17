// The mesh of a tank's particles, blended over the solids on the canvas (premultiplied): the sky in its mirror, the light from below it from
// the vertices, and white water torn by the noise. There are no branches: software renderers execute both sides of one.
#include <sky>

in vec4 v_under;
in vec3 v_ray;
in vec3 v_normal;
in vec2 v_at_lace;
in vec2 v_white_pane;
uniform vec3 u_displayed_sun;
uniform vec3 u_displayed_foam;
uniform sampler2D u_noise;
layout(location = 0) out vec4 color;

void main() {
  vec3 normal = v_normal * inversesqrt(max(dot(v_normal, v_normal), 1e-6));
  float along = min(dot(normal, v_ray), 0.0);
  float past = 1.0 + along;
  float past2 = past * past;
  float fresnel = (0.03 + 0.9 * past2 * past2 * past) * (1.0 - 0.8 * v_white_pane.y);
  vec3 mirrored = v_ray - (2.0 * along) * normal;
  vec3 sky = toDisplay(textureLod(u_sky, vec3(mirrored.x, abs(mirrored.y), mirrored.z), 0.0).rgb);
  float glint = clamp(1.0 - 60.0 * (1.0 - dot(mirrored, u_sun_direction)), 0.0, 1.0) * (1.0 - v_white_pane.y);
  vec3 light = mix(v_under.rgb, sky, fresnel) + u_displayed_sun * (glint * glint * 0.5);
  float seen = v_under.a * (1.0 - fresnel);
  float lace = textureLod(u_noise, v_at_lace, 0.0).r;
  float white = 0.9 * clamp(2.5 * (lace - 1.0 + 1.4 * v_white_pane.x), 0.0, 1.0);
  vec3 froth = u_displayed_foam * (0.8 + 0.2 * normal.y);
  color = vec4(mix(light, froth, white), 1.0 - seen * (1.0 - white));
}
