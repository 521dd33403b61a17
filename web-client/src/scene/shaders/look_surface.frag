// The water's surface in the colours of a value, or with Phong's lighting (B. T. Phong, 1975): ambient, diffuse and specular light, opaque.
// Outside the simulated square, on the sides of a block of water, and without a value the lighting is used.
// OF_VALUE: of u_value. OF_BREAKING: of the breaking criterion, from the velocity in u_value. OF_FOAM: of the foam, in percent.
// BEACH, OPEN_SEA, SKIRT: as in water.frag.
#include <sky>
#if defined(OF_VALUE) || defined(OF_BREAKING) || defined(OF_FOAM)
#define COLOURED
#include <look_map>
#endif

in vec3 v_world;
in float v_view_z;
in float v_top_m;
#ifdef SKIRT
in vec3 v_side_normal;
#endif

uniform vec3 u_camera_m;
uniform sampler2D u_field;
uniform sampler2D u_behind_depth;
uniform vec2 u_resolution;
uniform vec2 u_extent_m;  // length and width of the water
uniform float u_depth_m;
uniform vec3 u_paint;   // albedo
uniform float u_shine;  // of the highlight
#if defined(OF_VALUE) || defined(OF_BREAKING)
uniform sampler2D u_value;
#endif
#ifdef OF_BREAKING
uniform float u_gravity_mps2;
uniform float u_least_depths;  // of u_depth_m
#endif
#ifdef OF_FOAM
uniform sampler2D u_foam_from;
uniform sampler2D u_foam_to;
uniform float u_foam_mix;
#endif
#if defined(BEACH) || defined(OF_BREAKING)
#include <bed>
#endif
#ifdef OPEN_SEA
#include <sea_blend>
in vec2 v_share_away;
uniform float u_haze_m;
#endif
layout(location = 0) out vec4 color;

#ifdef COLOURED
float valueAt(vec2 uv) {
#ifdef OF_FOAM
  return 100.0 * mix(textureLod(u_foam_from, uv, 0.0).r, textureLod(u_foam_to, uv, 0.0).r, u_foam_mix);
#elif defined(OF_BREAKING)
  vec2 half_uv = 0.5 / vec2(textureSize(u_value, 0));
  float rate_mps = 0.25 * (textureLod(u_value, uv - half_uv, 0.0).r + textureLod(u_value, uv + half_uv, 0.0).r +
                           textureLod(u_value, uv + half_uv * vec2(1.0, -1.0), 0.0).r + textureLod(u_value, uv + half_uv * vec2(-1.0, 1.0), 0.0).r);
  float depth_m = max(bedDepth((uv - 0.5) * u_extent_m, u_extent_m, u_depth_m), u_least_depths * u_depth_m);
  return rate_mps * inversesqrt(u_gravity_mps2 * depth_m);
#else
  return textureLod(u_value, uv, 0.0).r;
#endif
}
#endif

void main() {
  if (textureLod(u_behind_depth, gl_FragCoord.xy / u_resolution, 0.0).r < gl_FragCoord.z) discard;
#ifdef BEACH
  if (v_top_m + bedDepth(v_world.xz, u_extent_m, u_depth_m) <= 0.0) discard;
#endif
  vec2 uv = v_world.xz / u_extent_m + 0.5;
#if defined(COLOURED) && !defined(SKIRT)
  if (all(lessThanEqual(abs(uv - 0.5), vec2(0.5)))) {
    color = vec4(mapped(valueAt(uv)), 1.0);
    return;
  }
#endif
#ifdef SKIRT
  vec3 normal = v_side_normal;
#else
  vec2 slope = textureLod(u_field, uv, 0.0).gb;
#ifdef OPEN_SEA
  // Waves smaller than a pixel are flat.
  float seen = smoothstep(0.05, 0.01, -v_view_z / (u_resolution.y * u_tiles_m.x));
  slope = mix(seen * textureLod(u_swell, v_world.xz / u_tiles_m.x, 0.0).gb, slope, v_share_away.x);
#endif
  vec3 normal = normalize(vec3(-slope.x, 1.0, -slope.y));
#endif
  vec3 from_eye = v_world - u_camera_m;
  float distance_m = length(from_eye);
  vec3 ray = from_eye / distance_m;
  float diffuse = max(dot(normal, u_sun_direction), 0.0);
  float specular = pow(max(dot(reflect(ray, normal), u_sun_direction), 0.0), 40.0);
  vec3 light = u_paint * (0.35 + 0.9 * diffuse) + u_shine * specular;
#ifdef OPEN_SEA
  float hazy = max(distance_m - 2.0 * max(u_extent_m.x, u_extent_m.y), 0.0) / u_haze_m;
  if (hazy > 0.01) light = mix(light, textureLod(u_sky, vec3(ray.x, max(ray.y, 0.01), ray.z), 0.0).rgb, 0.85 * hazy / (1.0 + hazy));
#endif
  color = vec4(toDisplay(light), 1.0);
}
