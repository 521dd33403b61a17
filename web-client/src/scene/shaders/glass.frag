// A pane of glass: the room reflected by Fresnel's equations, a little green in its thickness. Blended: the colour is added to what is
// behind times alpha.
#include <sky>

in vec3 v_world;
in vec3 v_normal;
uniform vec3 u_camera_m;
layout(location = 0) out vec4 color;

void main() {
  vec3 ray = normalize(v_world - u_camera_m);
  vec3 normal = normalize(v_normal);
  float facing = abs(dot(normal, ray));
  float away = (1.0 - facing) * (1.0 - facing);
  // Two faces reflect.
  float fresnel = 0.05 + 0.7 * away * away * (1.0 - facing);
  vec3 mirrored = reflect(ray, normal);
  vec3 light = skyLight(mirrored) * fresnel;
  // What is behind is already on the screen in display values; light of this size adds about linearly there.
  color = vec4(toDisplay(light) * 0.45, 0.94 * (1.0 - fresnel));
}
