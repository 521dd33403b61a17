// A drop in a tank: a lens that shows the sky upside down, bright where it mirrors the light from above; with air in it white. Or a puff
// of spray.
#include <sky>

flat in vec3 v_flight;
flat in vec2 v_strength_white;  // white: 0..1
flat in vec4 v_puff;
uniform mat4 u_camera_world;
uniform vec2 u_target_px;
uniform sampler2D u_behind_depth;
#include <puff>
layout(location = 0) out vec4 color;

const vec3 kFroth = vec3(0.84, 1.0, 1.14);

void main() {
  vec2 at = vec2(gl_PointCoord.x, 1.0 - gl_PointCoord.y) * 2.0 - 1.0;
  vec2 local = vec2(dot(at, v_flight.xy), dot(at, vec2(-v_flight.y, v_flight.x)) / v_flight.z);
  float away2 = dot(local, local);
  if (away2 > 1.0) discard;
  if (texture(u_behind_depth, gl_FragCoord.xy / u_target_px).r < gl_FragCoord.z) discard;
  if (v_puff.x >= 0.0) {
    color = vec4(toDisplay(kFroth * (0.6 * u_sun_light + u_ambient_up)), v_strength_white.x * puffAt(at, v_flight.xy, v_puff));
    return;
  }
  vec2 screen = v_flight.xy * local.x + vec2(-v_flight.y, v_flight.x) * local.y;
  vec3 normal = mat3(u_camera_world) * vec3(screen, sqrt(1.0 - away2));
  vec3 toward = mat3(u_camera_world) * vec3(0.0, 0.0, 1.0);
  vec3 mirrored_ray = reflect(-toward, normal);
  // A ball of water turns a ray by twice the difference of its angles to the normal in air and in water.
  vec3 inward = mat3(u_camera_world) * vec3(-screen, 0.0);
  vec3 lens = (0.8 - 0.7 * screen.y) * textureLod(u_sky, inward * (0.55 + 0.45 * away2 * away2) - toward, 1.0).rgb;
  vec3 mirrored = textureLod(u_sky, mirrored_ray, 2.0).rgb;
  vec3 glint = u_sun_sharp * u_sun_light * pow(max(dot(mirrored_ray, u_sun_direction), 0.0), 30.0) * 4.0;
  vec3 light = mix(lens, mirrored, 0.06 + 0.9 * away2 * away2) + glint;
  float sun = clamp(dot(normal, u_sun_direction) * 0.5 + 0.5, 0.0, 1.0);
  vec3 froth = kFroth * (u_sun_light * mix(0.6, 1.2, sun * sun) + u_ambient_up);
  float white = 0.1 + 0.7 * v_strength_white.y;
  // Through the middle of a clear drop one sees about what is behind it.
  color = vec4(toDisplay(mix(light, froth, white)), v_strength_white.x * smoothstep(1.0, 0.6, away2) * mix(0.45 + 0.5 * away2, 1.0, white));
}
