// A pane of glass: the sky reflected by Fresnel's equations, a little green in its thickness; its cut edges collect light. Blended: the
// colour is added to what is behind times alpha.
#include <sky>

in vec3 v_world;
in vec3 v_normal;
in vec4 v_color;
uniform vec3 u_camera_m;
layout(location = 0) out vec4 color;

const float kBrightest = 0.2;  // of what a pane mirrors: the sky would be a veil before the water

const vec3 kTint = vec3(0.008, 0.018, 0.02);  // added by each face: a pane is seen, not only its edges

void main() {
  vec3 ray = normalize(v_world - u_camera_m);
  vec3 normal = normalize(v_normal);
  float facing = abs(dot(normal, ray));
  float away = (1.0 - facing) * (1.0 - facing);
  // Two faces reflect.
  float fresnel = 0.015 + 0.45 * away * away * (1.0 - facing);
  // What is behind is on the screen in display values already, whose squares are about linear: a dim reflection adds little to them.
  vec3 mirrored = toDisplay(min(skyLight(reflect(ray, normal)), vec3(kBrightest)) * fresnel);
  color = vec4(mirrored * mirrored + kTint, 0.98 * (1.0 - fresnel));
  if (v_color.a > 0.5) {
    vec3 edge = toDisplay(vec3(0.04, 0.13, 0.13) * (u_ambient_up + 0.4 * u_sun_light) + 0.12 * textureLod(u_sky, reflect(ray, normal), 4.0).rgb);
    color = vec4(0.4 * edge, 0.5);
  }
}
