// Intersects the pixel's ray with a sphere: exact normal and depth, an edge one pixel soft, sky reflected outside the water.
#include <sky>
#include <particle_color>

flat in vec3 v_center_m;
flat in float v_radius_m;
flat in vec2 v_tint_foam;
flat in float v_world_y_m;
flat in float v_above_m;

uniform mat4 projectionMatrix;
uniform mat4 u_inverse_projection;
uniform mat4 u_camera_world;
uniform vec2 u_resolution;
uniform float u_radius_m;
uniform float u_depth_m;
layout(location = 0) out vec4 color;

void main() {
  vec4 far = u_inverse_projection * vec4(gl_FragCoord.xy / u_resolution * 2.0 - 1.0, 1.0, 1.0);
  vec3 ray = normalize(far.xyz / far.w);
  float along = dot(ray, v_center_m);
  float miss2 = dot(v_center_m, v_center_m) - along * along;
  float pixel_m = 2.0 * along / (projectionMatrix[1][1] * u_resolution.y);
  float covered = (v_radius_m - sqrt(miss2)) / pixel_m + 0.5;
  if (covered <= 0.0) discard;
  vec3 hit = ray * (along - sqrt(max(v_radius_m * v_radius_m - miss2, 0.0)));
  vec3 normal_view = normalize(hit - v_center_m);
  vec3 normal = mat3(u_camera_world) * normal_view;

  // A sphere whose centre is in the water is cut just under the surface, so that the particles below look like water. A sphere that has
  // left the water is whole.
  float out_of_water = outOfWater(v_above_m, u_radius_m);
  float highest_m = v_world_y_m - v_above_m - 0.2 * u_radius_m + out_of_water * 2.5 * u_radius_m;
  vec3 world_ray = mat3(u_camera_world) * ray;
  float over_m = v_world_y_m + normal.y * u_radius_m - highest_m;
  if (over_m > 0.0 && world_ray.y < -0.02) hit += ray * min(over_m / -world_ray.y, 2.0 * u_radius_m);
  // A soft edge pixel is moved back, so that what is drawn later behind it covers it and no rim of the background remains.
  if (covered < 1.0) hit += ray * 2.0 * v_radius_m;
  vec4 clip = projectionMatrix * vec4(hit, 1.0);
  gl_FragDepth = clamp(0.5 * clip.z / clip.w + 0.5, 0.0, 1.0);

  vec3 toward_eye = -world_ray;
  float foam = foamShare(v_tint_foam.y, out_of_water);
  vec3 albedo = particleAlbedo(v_tint_foam.x, foam, out_of_water);

  float sun = clamp(dot(normal, u_sun_direction) * 0.6 + 0.4, 0.0, 1.0);
  vec3 ambient = mix(kAmbientBelow, kAmbientAbove, normal.y * 0.5 + 0.5);
  vec3 lit = albedo * (kSunColor * 1.15 * sun * sun + ambient * (1.0 + 0.35 * foam)) * lightReaching(v_world_y_m, u_depth_m, out_of_water);

  // No gloss inside the water.
  float gloss = (1.0 - 0.8 * foam) * out_of_water;
  if (gloss > 0.01) {
    float away = 1.0 - clamp(dot(normal, toward_eye), 0.0, 1.0);
    float grazing = away * away * away * away;
    vec3 mirrored = reflect(-toward_eye, normal);
    lit += gloss * (0.04 + 0.38 * grazing) * skyLight(mirrored);
    lit += gloss * kSunColor * 1.6 * pow(max(dot(mirrored, u_sun_direction), 0.0), 60.0);
  }
  color = vec4(lit, min(covered, 1.0));
}
