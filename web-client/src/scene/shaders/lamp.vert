// The glow of a lamp: a quad that faces the camera, at least a few pixels wide. A beam: a ribbon from its lamp, turned to the camera.
// A glow is as bright as the share of its lamp that no solid hides; what a beam passes behind is found per pixel (lamp.frag).
in vec3 position;  // corner, -1..1
in vec4 a_at;      // position and radius (m)
in vec4 a_color;   // colour; 1: the height is over the water's surface
in vec3 a_reach;   // end of the beam from its lamp (m); 0: a glow
uniform mat4 viewMatrix;
uniform mat4 projectionMatrix;
uniform vec3 u_camera_m;
uniform sampler2D u_behind_depth;
uniform vec2 u_resolution;
uniform sampler2D u_field;
uniform vec2 u_extent_m;  // length and width of the water
out vec2 v_corner;
flat out vec4 v_color;  // a: 1 for a beam

const float kLeastView = 0.012;  // radius of a glow over its distance

float seen(vec4 clip, vec2 shift_px) {
  vec3 at = clip.xyz / clip.w * 0.5 + 0.5;
  return step(at.z, textureLod(u_behind_depth, at.xy + shift_px / u_resolution, 0.0).r);
}

void main() {
  vec3 at = a_at.xyz;
  if (a_color.w > 0.5) at.y += textureLod(u_field, at.xz / u_extent_m + 0.5, 0.0).r;
  v_corner = position.xy;
  vec3 toward = normalize(u_camera_m - at);
  float is_beam = step(1e-6, dot(a_reach, a_reach));
  if (is_beam > 0.5) {
    float along = 0.5 + 0.5 * position.y;
    vec3 axis = normalize(a_reach);
    vec3 side = cross(axis, toward);
    side /= max(length(side), 1e-3);
    vec3 place = at + along * a_reach + side * position.x * a_at.w * mix(0.06, 1.0, along);
    // Brighter toward the camera, as light scatters mostly forward.
    float forward = max(dot(axis, toward), 0.0);
    v_color = vec4(a_color.rgb * (0.12 + 0.5 * forward * forward * forward), 1.0);
    gl_Position = projectionMatrix * viewMatrix * vec4(place, 1.0);
    return;
  }
  vec4 view = viewMatrix * vec4(at, 1.0);
  float distance_m = length(u_camera_m - at);
  float radius_m = max(a_at.w, kLeastView * distance_m);
  // In front of the lamp's own housing.
  view.xyz *= 1.0 - min(0.4 * a_at.w / max(distance_m, 1e-3), 0.5);
  vec4 middle = projectionMatrix * view;
  float share = 0.2 * (seen(middle, vec2(0.0)) + seen(middle, vec2(2.0, 0.0)) + seen(middle, vec2(-2.0, 0.0)) + seen(middle, vec2(0.0, 2.0)) + seen(middle, vec2(0.0, -2.0)));
  v_color = vec4(a_color.rgb * share, 0.0);
  view.xy += position.xy * radius_m;
  gl_Position = share > 0.0 ? projectionMatrix * view : vec4(0.0, 0.0, 2.0, 1.0);
}
