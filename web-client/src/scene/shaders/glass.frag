// A pane of glass: the room reflected by Fresnel's equations, a little green in its thickness, brighter at its edges. Blended: the colour
// is added to what is behind times alpha. Reads v_color.a: 1 on the upper edge of a pane.
#include <sky>

in vec3 v_world;
in vec3 v_normal;
in vec4 v_color;
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
  float edge = v_color.a;
  light += edge * vec3(0.42, 0.64, 0.45) * u_ambient_up;
  float through = (1.0 - fresnel) * mix(0.94, 0.45, edge);
  // What is behind is already on the screen in display values; light of this size adds about linearly there.
  color = vec4(toDisplay(light) * mix(0.45, 1.0, edge), through);
}
