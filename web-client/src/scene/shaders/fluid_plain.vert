// The mesh of a tank's particles (fluid/plain_surface.ts): the light from below its surface, for the display, as in water_plain.glsl.
#include <sky>
#include <water_optics>

in vec3 position;
in vec3 normal;
in vec2 a_length_white;        // length of the water behind it (m); white share
uniform mat4 viewMatrix;
uniform mat4 projectionMatrix;
uniform vec3 u_camera_m;
uniform vec3 u_half_m;         // half of the tank's length and width, and the width of a cell
uniform float u_floor_m;
uniform float u_colour_ratio;  // lengths in the water of a tank count as so much longer for its colour
uniform float u_lace_m;

out vec4 v_under;    // light from below the surface times its share; share of what is behind that is seen
out vec3 v_ray;      // from the camera, of length 1
out vec3 v_normal;
out vec2 v_at_lace;  // on the noise
out vec2 v_white_pane;  // white share; 1 at a pane

// Share of the light from all sides that what is behind the water sends on.
const float kBehind = 0.3;

void main() {
  v_ray = normalize(position - u_camera_m);
  v_normal = normal;
  // The panes and the floor mirror little: glass hides it.
  vec2 left_m = u_half_m.xy - abs(position.xz);
  v_white_pane = vec2(smoothstep(0.05, 0.75, a_length_white.y), 1.0 - smoothstep(0.0, 0.4 * u_half_m.z, min(min(left_m.x, left_m.y), position.y - u_floor_m)));
  v_at_lace = (position.xz + 0.7 * position.y) / u_lace_m;
  vec3 loss = u_loss_per_m * (a_length_white.x * u_colour_ratio);
  vec3 passed = 1.0 / (1.0 + loss * (1.0 + loss * (0.5 + loss * 0.1667)));
  float sun = clamp(dot(normal, u_sun_direction) * 0.5 + 0.5, 0.0, 1.0);
  vec3 scattered = waterScattered(0.25 + 0.4 * clamp(normal.y, 0.0, 1.0)) * u_water_light * (1.2 + 2.2 * sun);
  float against_sun = max(dot(v_ray, u_sun_direction), 0.0);
  scattered += u_crest * u_sun_light * (0.35 * against_sun * against_sun);
  // Blending has one share for all colours: light from all sides makes up for the difference.
  float seen = min(passed.r, min(passed.g, passed.b));
  vec3 light = scattered * (1.0 - passed) + kBehind * (u_ambient_up + u_ambient_down) * (passed - seen);
  v_under = vec4(toDisplay(light / max(1.0 - seen, 0.02)) * (1.0 - seen), seen);
  gl_Position = projectionMatrix * viewMatrix * vec4(position, 1.0);
}
