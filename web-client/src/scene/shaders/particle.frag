// A sphere hit by the pixel's ray: exact normal and depth. Colour: deep blue where dense, light cyan where thin, white foam.
#include <sky>

in vec3 v_view_m;
flat in vec3 v_center_m;
flat in vec2 v_tint_foam;
flat in float v_world_y_m;

uniform mat4 projectionMatrix;
uniform mat4 u_camera_world;
uniform float u_radius_m;
uniform float u_depth_m;
layout(location = 0) out vec4 color;

void main() {
  vec3 ray = normalize(v_view_m);
  float along = dot(ray, v_center_m);
  float miss2 = dot(v_center_m, v_center_m) - along * along;
  float inside2 = u_radius_m * u_radius_m - miss2;
  if (inside2 < 0.0) discard;
  vec3 hit = ray * (along - sqrt(inside2));
  vec3 normal_view = (hit - v_center_m) / u_radius_m;
  vec4 clip = projectionMatrix * vec4(hit, 1.0);
  gl_FragDepth = clamp(0.5 * clip.z / clip.w + 0.5, 0.0, 1.0);

  vec3 normal = mat3(u_camera_world) * normal_view;
  vec3 toward_eye = -(mat3(u_camera_world) * ray);
  float dense = smoothstep(0.30, 0.92, v_tint_foam.x);
  vec3 water = mix(vec3(0.30, 0.78, 0.88), vec3(0.012, 0.15, 0.42), dense);
  float foam = smoothstep(0.02, 0.75, v_tint_foam.y);
  vec3 albedo = mix(water, vec3(0.93, 0.97, 1.0), foam);

  float sun = clamp(dot(normal, u_sun_direction) * 0.6 + 0.4, 0.0, 1.0);
  vec3 ambient = mix(vec3(0.16, 0.22, 0.28), vec3(0.52, 0.66, 0.84), normal.y * 0.5 + 0.5);
  float buried = clamp(-v_world_y_m / u_depth_m, 0.0, 1.0);
  vec3 lit = albedo * (kSunColor * 1.25 * sun * sun + ambient) * mix(1.0, 0.6, buried);

  float grazing = pow(1.0 - clamp(dot(normal, toward_eye), 0.0, 1.0), 4.0);
  vec3 mirrored = reflect(-toward_eye, normal);
  float gloss = 1.0 - 0.8 * foam;
  lit += gloss * (0.04 + 0.38 * grazing) * skyLight(mirrored);
  lit += gloss * kSunColor * 1.6 * pow(max(dot(mirrored, u_sun_direction), 0.0), 60.0);
  color = vec4(lit, 1.0);
}
