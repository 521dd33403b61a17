// The water's surface in the plain tiers, blended over the solids on the canvas (premultiplied): clear colours and sharp edges at full resolution
// instead of refraction and mirrored solids. Most of it comes from the vertices (water_plain.glsl), for the display, so that a pixel only mixes.
// There are no branches: software renderers execute both sides of one.
// SKIRT and OPEN_SEA as in water.frag.
#include <sky>
#ifdef SKIRT
#include <water_optics>
#endif

#ifdef SKIRT
in vec3 v_world;
in float v_top_m;
in vec3 v_side_normal;
uniform vec3 u_camera_m;
uniform vec2 u_extent_m;  // length and width of the water
uniform float u_depth_m;
uniform float u_colour_ratio;  // lengths in the water of a tank count as so much longer for its colour
#else
in vec4 v_under;
in vec3 v_ray;
in vec4 v_slopes;
in vec2 v_shares;
in vec2 v_foam_light;
in vec2 v_at;
#endif
#ifdef DIVED
uniform sampler2D u_behind_depth;
uniform vec2 u_resolution;
#endif
#ifdef OPEN_SEA
#include <ripples>
#endif
uniform vec3 u_displayed_sky[3];  // zenith, middle, horizon
uniform vec3 u_displayed_sun;
uniform vec3 u_displayed_glow;
uniform vec3 u_displayed_foam;
uniform sampler2D u_noise;
uniform float u_lace_m;
layout(location = 0) out vec4 color;

#ifdef SKIRT
// Distance from a side of the water along `ray` to another side or the floor.
float wayOut(vec3 from, vec3 ray) {
  vec3 high = vec3(0.5 * u_extent_m.x, 1e3, 0.5 * u_extent_m.y);
  vec3 low = vec3(-high.x, -u_depth_m, -high.z);
  vec3 safe = mix(vec3(1e-6), ray, step(vec3(1e-6), abs(ray)));
  vec3 t = max((high - from) / safe, (low - from) / safe);
  return max(min(t.x, min(t.y, t.z)), 0.0);
}

void main() {
  vec3 ray = normalize(v_world - u_camera_m);
  vec3 loss = u_loss_per_m * (u_colour_ratio * wayOut(v_world, ray) * (1.0 + max(-ray.y, 0.25)));
  vec3 passed = 1.0 / (1.0 + loss * (1.0 + loss * (0.5 + loss * 0.1667)));
  float seen = (passed.r + passed.g + passed.b) / 3.0;
  vec3 scattered = waterScattered(smoothstep(-0.5, 0.9, v_top_m)) * u_water_light;
  float fresnel = 0.8 * waterFresnel(clamp(-dot(v_side_normal, ray), 0.0, 1.0));
  float rim = smoothstep(min(0.07, 0.1 * u_depth_m), 0.0, v_top_m - v_world.y);
  vec3 mirrored = reflect(ray, v_side_normal);
  // Each colour's own share of what the water hides.
  scattered *= (1.0 - passed) / max(1.0 - seen, 0.02);
  vec3 light = mix(scattered, textureLod(u_sky, vec3(mirrored.x, abs(mirrored.y), mirrored.z), 0.0).rgb, fresnel) + rim * vec3(0.10, 0.20, 0.23) * u_water_light;
  float cover = 1.0 - seen * (1.0 - fresnel) * (1.0 - 0.5 * rim);
  color = vec4(toDisplay(light) * cover, cover);
}
#else
void main() {
#ifdef DIVED
  // The solids are not on the canvas.
  if (texture(u_behind_depth, gl_FragCoord.xy / u_resolution).r < gl_FragCoord.z) discard;
#endif
  vec2 slope = v_slopes.xy;
#ifdef OPEN_SEA
  vec2 ripples_at = v_at / u_tiles_m.y;
  slope += v_slopes.z * textureLod(u_ripples, ripples_at, 0.0).gb;
  // The finer copy of ripples.glsl, near the camera.
  slope += max(3.0 * v_slopes.z - 2.0, 0.0) * (textureLod(u_ripples, kTurnedRipples * ripples_at * kFinerRipples, 0.0).gb * kTurnedRipples);
#endif
  vec3 normal = vec3(-slope.x, 1.0, -slope.y) * inversesqrt(1.0 + dot(slope, slope));
  float along = dot(normal, v_ray);
  float past = clamp(1.0 + along, 0.0, 1.0);
  float past2 = past * past;
  float fresnel = v_shares.x * (0.02 + 0.98 * past2 * past2 * past);
  vec3 mirrored = v_ray - (2.0 * along) * normal;
  float up = abs(mirrored.y) + v_slopes.w;
  vec3 sky = mix(u_displayed_sky[2], u_displayed_sky[1], clamp(6.0 * up, 0.0, 1.0));
  sky = mix(sky, u_displayed_sky[0], clamp(1.7 * up - 0.25, 0.0, 1.0));
  // The glow around the sun, and its image.
  float at_sun = max(mirrored.x * u_sun_direction.x + up * u_sun_direction.y + mirrored.z * u_sun_direction.z, 0.0);
#ifdef OPEN_SEA
  at_sun *= inversesqrt(dot(mirrored.xz, mirrored.xz) + up * up);
#endif
  float glow = at_sun * at_sun;
  sky += u_displayed_glow * (glow * glow);
  float glint = clamp(1.0 - 250.0 * (1.0 - at_sun), 0.0, 1.0);
  glint *= glint * (0.4 + fresnel);
  // Haze has the colour of the horizon, which water far out mirrors.
  fresnel = mix(fresnel, 1.0, v_shares.y);
  vec3 light = mix(v_under.rgb, sky, fresnel) + u_displayed_sun * glint;
  float seen = v_under.a * (1.0 - fresnel);
  light *= v_foam_light.y;
  // Patches that thin out toward their outlines. Large breakers tear them; small, steep waves would fold them into rings.
  vec2 lace_at = v_at;
#ifdef OPEN_SEA
  lace_at -= 0.6 * slope;
#endif
  float lace = textureLod(u_noise, lace_at / u_lace_m, 0.0).r;
  float white = 0.92 * clamp(2.6 * (lace - 1.0 + v_foam_light.x), 0.0, 1.0);
  light = mix(light, (0.7 + 0.3 * lace) * u_displayed_foam, white);
  seen *= 1.0 - white;
  color = vec4(light, 1.0 - seen);
}
#endif
