// Include: what stands between a point and the sun, from shadows/shadow_pass.ts. After <sky>.
uniform highp sampler2DShadow u_shadow;
uniform mat4 u_shadow_matrix;    // world → map, all three in 0..1
uniform vec2 u_shadow_texel_m;

const int kShadowSamples = 12;

// Share of the direct light that arrives at a point of a surface, averaged over a disc of radius `soft_m` across the light. Positions outside
// the map are lit, and clouds leave no shadow.
float sunShare(vec3 world, vec3 normal, float soft_m) {
  vec2 size = vec2(textureSize(u_shadow, 0));
  // At least two texels, so that the map's own steps do not show.
  vec2 radius = max(vec2(soft_m) / u_shadow_texel_m, 2.0) / size;
  float off_m = 1.5 * max(u_shadow_texel_m.x, u_shadow_texel_m.y);
  vec3 at = (u_shadow_matrix * vec4(world + normal * off_m, 1.0)).xyz;
  vec3 inside = smoothstep(vec3(0.5), vec3(0.47), abs(at - 0.5));
  float known = inside.x * inside.y * step(1e-4, inside.z);
  if (known <= 0.0) return 1.0;
  // The surface continues as a plane: its distance from the light changes over the disc.
  vec3 across = vec3(u_shadow_matrix[0].x, u_shadow_matrix[1].x, u_shadow_matrix[2].x);
  vec3 upward = vec3(u_shadow_matrix[0].y, u_shadow_matrix[1].y, u_shadow_matrix[2].y);
  vec3 away = vec3(u_shadow_matrix[0].z, u_shadow_matrix[1].z, u_shadow_matrix[2].z);
  float facing = max(-dot(normal, normalize(away)), 0.06);
  vec2 slope = vec2(dot(normal, across) / dot(across, across), dot(normal, upward) / dot(upward, upward)) * length(away) / facing;
  float sum = 0.0;
  for (int i = 0; i < kShadowSamples; ++i) {
    // Vogel's spiral.
    float angle = 2.39996323 * float(i);
    vec2 step_uv = radius * sqrt((float(i) + 0.5) / float(kShadowSamples)) * vec2(cos(angle), sin(angle));
    sum += texture(u_shadow, vec3(at.xy + step_uv, at.z + dot(slope, step_uv)));
  }
  return mix(1.0, sum / float(kShadowSamples), known * u_sun_sharp);
}
