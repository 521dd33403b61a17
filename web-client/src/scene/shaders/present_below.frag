// The scene without its surface, where the eye or a part of the picture is below it: pixels whose way begins in the water are veiled by it.
#include <sky>
#include <water_optics>
#include <below>

in vec3 v_direction;
uniform vec3 u_camera_m;
uniform vec3 u_camera_ahead;
uniform sampler2D u_behind;
uniform sampler2D u_behind_depth;
uniform vec2 u_resolution;
layout(location = 0) out vec4 color;

const float kLinePx = 2.5;

void main() {
  vec2 uv = gl_FragCoord.xy / u_resolution;
  vec3 ray = normalize(v_direction);
  float ahead = dot(ray, u_camera_ahead);
  // The nearest position that can be drawn.
  vec3 begin = u_camera_m + ray * (u_near_far_m.x / ahead);
  vec3 light = texture(u_behind, uv).rgb;
  float over_m = begin.y - waterLevel(begin.xz);
  // A dark line marks where the surface meets the picture.
  float line = 1.0 - smoothstep(0.5 * kLinePx, kLinePx, abs(over_m) / max(fwidth(over_m), 1e-6));
  float depth = texture(u_behind_depth, uv).r;
  float solid_m = -viewZ(depth) / ahead;
  // A solid in the water that no surface covers: the grid of the surface and its texture differ a little at the picture's edge of the water.
  bool isSolidInWater = depth < 1.0 && isInWater(u_camera_m + ray * solid_m);
  if (isInWater(begin) || isSolidInWater) {
    float way_m = wayOut(u_camera_m, ray);
    if (depth < 1.0) way_m = min(way_m, solid_m);
#ifdef OPEN_SEA
    // The level bed is not drawn everywhere.
    else light = floorLight();
#endif
    light = throughWater(light, u_camera_m, ray, way_m, shaftsAlong(u_camera_m, ray, way_m));
  }
  color = vec4(toDisplay(light * (1.0 - 0.6 * line)), 1.0);
}
