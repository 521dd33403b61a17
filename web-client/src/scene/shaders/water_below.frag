// The water's surface from below: through Snell's window the sky, the sun and solids, refracted; outside it the floor, reflected totally.
// What is between the surface and the eye veils it. PLAIN: without solids above. OPEN_SEA: the water continues, with ripples.
#include <sky>
#include <water_optics>
#include <below>

in vec3 v_world;
in float v_view_z;
uniform vec3 u_camera_m;
uniform mat4 viewMatrix;
uniform mat4 projectionMatrix;
uniform sampler2D u_behind;
uniform sampler2D u_behind_depth;
uniform vec2 u_resolution;
#ifdef OPEN_SEA
in vec2 v_share_away;
#endif
#ifdef FOAM
uniform sampler2D u_foam_from;
uniform sampler2D u_foam_to;
uniform float u_foam_mix;
#endif
uniform sampler2D u_froth;
uniform sampler2D u_noise;
uniform float u_lace_m;
layout(location = 0) out vec4 color;

const float kWaterPerAir = 1.0 / 0.75;

vec2 slopes() {
#ifdef OPEN_SEA
  vec2 slope = v_share_away.x > 0.0 ? textureLod(u_field, v_world.xz / u_extent_m + 0.5, 0.0).gb : vec2(0.0);
  slope = mix(texture(u_swell, v_world.xz / u_tiles_m.x).gb, slope, v_share_away.x);
  return slope + texture(u_ripples, v_world.xz / u_tiles_m.y).gb;
#else
  return texture(u_field, v_world.xz / u_extent_m + 0.5).gb;
#endif
}

// Fresnel's equations for light that leaves water; 1 where it is reflected totally.
float fresnelBelow(float facing) {
  float sine2 = kWaterPerAir * kWaterPerAir * (1.0 - facing * facing);
  if (sine2 >= 1.0) return 1.0;
  float leaving = sqrt(1.0 - sine2);
  float across = (kWaterPerAir * facing - leaving) / (kWaterPerAir * facing + leaving);
  float along = (kWaterPerAir * leaving - facing) / (kWaterPerAir * leaving + facing);
  return 0.5 * (across * across + along * along);
}

// Share of the surface that is covered by foam, as in water.frag.
float foamCover() {
  vec2 place = v_world.xz / u_extent_m + 0.5;
  float foam = textureLod(u_froth, place, 0.0).r;
#ifdef FOAM
  foam = max(foam, mix(textureLod(u_foam_from, place, 0.0).r, textureLod(u_foam_to, place, 0.0).r, u_foam_mix));
#endif
#ifdef OPEN_SEA
  foam *= v_share_away.x;
#endif
  if (foam < 0.01) return 0.0;
  float strength = min(1.1 * foam * sqrt(foam) + 0.1, 1.0);
  return smoothstep(1.0 - strength, 1.16 - 0.7 * strength, texture(u_noise, v_world.xz / u_lace_m).r) * smoothstep(0.0, 0.35, foam);
}

// Position on the screen, and whether it is there.
bool onScreen(vec3 at, out vec2 uv, out float view_z) {
  vec4 view = viewMatrix * vec4(at, 1.0);
  vec4 clip = projectionMatrix * view;
  view_z = view.z;
  uv = clip.xy / clip.w * 0.5 + 0.5;
  return clip.w > 0.0 && all(lessThan(abs(uv - 0.5), vec2(0.5)));
}

vec3 airLight(vec3 direction) {
  vec3 up = normalize(vec3(direction.x, max(direction.y, 0.02), direction.z));
  vec3 light = skyLight(up);
  float at_sun = max(dot(direction, u_sun_direction), 0.0);
  light += u_sun_light * u_sun_sharp * (12.0 * pow(at_sun, 1200.0) + 0.9 * pow(at_sun, 90.0));
#ifndef PLAIN
  // Solids above the water, as far as they are on the screen.
  float before_m = 0.0;
  for (int i = 1; i <= 10; ++i) {
    float along_m = 0.25 * max(u_extent_m.x, u_extent_m.y) * float(i * i) / 100.0;
    vec2 uv;
    float view_z;
    if (!onScreen(v_world + direction * along_m, uv, view_z)) break;
    float depth = texture(u_behind_depth, uv).r;
    float deep_m = viewZ(depth) - view_z;
    if (depth < 1.0 && deep_m > 0.0 && deep_m < 1.0 + 1.5 * (along_m - before_m)) {
      vec2 edge = smoothstep(0.5, 0.45, abs(uv - 0.5));
      return mix(light, texture(u_behind, uv).rgb, edge.x * edge.y);
    }
    before_m = along_m;
  }
#endif
  return light;
}

vec3 mirroredLight(vec3 direction) {
  float way_m = min(wayOut(v_world, direction), 60.0);
  vec3 light = floorLight();
#ifndef PLAIN
  vec2 uv;
  float view_z;
  if (onScreen(v_world + direction * way_m, uv, view_z)) {
    float away_m = abs(viewZ(texture(u_behind_depth, uv).r) - view_z);
    vec2 edge = smoothstep(0.5, 0.42, abs(uv - 0.5));
    light = mix(light, texture(u_behind, uv).rgb, edge.x * edge.y * (1.0 - smoothstep(0.05, 0.15, away_m / -view_z)));
  }
#endif
  return throughWater(light, v_world, direction, way_m, 1.0);
}

void main() {
  vec2 uv = gl_FragCoord.xy / u_resolution;
  if (texture(u_behind_depth, uv).r < gl_FragCoord.z) discard;
  vec3 from_eye = v_world - u_camera_m;
  float distance_m = length(from_eye);
  vec3 ray = from_eye / distance_m;
  vec2 slope = slopes();
  vec3 up = normalize(vec3(-slope.x, 1.0, -slope.y));
  float facing = dot(up, ray);
  // A slope that would show its upper side.
  if (facing < 0.02) {
    up = normalize(up + (0.02 - facing) * ray);
    facing = max(dot(up, ray), 0.0);
  }
  float fresnel = fresnelBelow(facing);
  vec3 light = vec3(0.0);
  if (fresnel < 1.0) light = (1.0 - fresnel) * airLight(refract(ray, -up, kWaterPerAir));
  if (fresnel > 0.02) light += fresnel * mirroredLight(reflect(ray, -up));
  // Foam lets through a part of the light that falls on it.
  light = mix(light, vec3(0.42, 0.50, 0.52) * (0.45 * u_sun_below + u_ambient_up), 0.85 * foamCover());
  color = vec4(toDisplay(throughWater(light, u_camera_m, ray, distance_m, shaftsAlong(u_camera_m, ray, distance_m))), 1.0);
}
