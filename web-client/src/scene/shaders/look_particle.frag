// A particle as a sphere. OF_SPEED, OF_DENSITY: in the colour of its value, which the middle shows unchanged; toward the rim it is darker.
// Otherwise with Phong's lighting, whiter where the density is low, as in the thesis (section 3.7.1).
#include <sky>
#if defined(OF_SPEED) || defined(OF_DENSITY)
#define COLOURED
#include <look_map>
#endif

flat in float v_ahead_m;
flat in float v_value;
uniform mat4 projectionMatrix;
uniform float u_radius_m;
uniform mat3 u_camera_world;
uniform sampler2D u_behind_depth;
uniform vec2 u_target_px;
layout(location = 0) out vec4 color;

void main() {
  vec2 at = (gl_PointCoord * 2.0 - 1.0) * vec2(1.0, -1.0);
  float off2 = dot(at, at);
  if (off2 > 1.0) discard;
  vec3 normal = vec3(at, sqrt(1.0 - off2));  // in view space
  float ahead_m = v_ahead_m - u_radius_m * normal.z;
  gl_FragDepth = clamp(0.5 * (projectionMatrix[3][2] / ahead_m - projectionMatrix[2][2]) + 0.5, 0.0, 1.0);
  if (textureLod(u_behind_depth, gl_FragCoord.xy / u_target_px, 0.0).r < gl_FragDepth) discard;
#ifdef COLOURED
  color = vec4(mapped(v_value) * mix(0.55, 1.0, smoothstep(0.0, 0.75, normal.z)), 1.0);
#else
  vec3 world_normal = u_camera_world * normal;
  vec3 toward_eye = u_camera_world * vec3(0.0, 0.0, 1.0);
  vec3 paint = mix(vec3(0.03, 0.20, 0.42), vec3(0.80, 0.88, 0.92), v_value);
  float diffuse = max(dot(world_normal, u_sun_direction), 0.0);
  float specular = pow(max(dot(reflect(-toward_eye, world_normal), u_sun_direction), 0.0), 40.0);
  color = vec4(toDisplay(paint * (0.35 + 0.9 * diffuse) + 0.35 * specular), 1.0);
#endif
}
