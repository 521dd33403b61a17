// The dark floor of the laboratory around a tank: a pool of light under the tank, which fades with the distance, and a polish that mirrors the walls.
// PLAIN: also for the display, without polish, slabs and shade.
#include <sky>
#ifdef SHADOWS
#include <shadow>
#endif

in vec3 v_world;
uniform vec3 u_camera_m;
uniform vec2 u_half_m;  // of the water
uniform float u_slab_m;
uniform sampler2D u_noise;
layout(location = 0) out vec4 color;

const vec3 kConcrete = vec3(0.085, 0.10, 0.12);
#ifdef PLAIN
const vec3 kFar = vec3(0.06, 0.095, 0.135);  // about the foot of the walls
#endif

void main() {
  vec2 away_m = max(abs(v_world.xz) - u_half_m, 0.0);
  // About a light's cosine law: it hangs as high as the tank is long.
  float away = dot(away_m, away_m) / (0.5 * (u_half_m.x * u_half_m.x + u_half_m.y * u_half_m.y));
  float pool = 1.0 / (1.0 + away);
  vec3 sun = u_sun_light * (1.25 * u_sun_direction.y);
#ifdef PLAIN
  vec3 lit = mix(kFar * u_ambient_up, kConcrete * (pool * pool) * (sun + u_ambient_up), smoothstep(0.05, 0.85, pool));
  if (u_is_displayed) lit = toDisplay(lit);
#else
#ifdef SHADOWS
  sun *= sunShare(v_world, vec3(0.0, 1.0, 0.0), 0.0);
#endif
  vec2 cell = v_world.xz / u_slab_m + 0.5;
  vec2 edge = 0.5 - abs(fract(cell) - 0.5);
  float blur = max(fwidth(cell.x), fwidth(cell.y));
  float joint = (1.0 - smoothstep(0.006 - 0.5 * blur, 0.006 + blur, min(edge.x, edge.y))) * min(0.02 / blur, 1.0);
  float stains = texture(u_noise, v_world.xz / (1.7 * u_slab_m)).r + texture(u_noise, v_world.zx / (0.37 * u_slab_m)).r - 1.0;
  vec3 lit = kConcrete * (1.0 + 0.25 * stains) * (1.0 - 0.6 * joint) * (pool * pool) * (sun + u_ambient_up);
  vec3 ray = normalize(v_world - u_camera_m);
  float past = 1.0 + ray.y;
  // Rough, it mirrors little but the walls.
  float mirror = (0.01 + 0.45 * past * past * past * past) * smoothstep(0.5, 0.2, -ray.y);
  lit += mirror * (1.0 - 0.6 * joint + 0.15 * stains) * textureLod(u_sky, vec3(ray.x, -ray.y, ray.z), 3.0).rgb;
  // Far away it fades into the foot of the walls: its end would be a line across the picture.
  lit = mix(textureLod(u_sky, vec3(ray.x, 0.02, ray.z), 2.0).rgb, lit, smoothstep(0.05, 0.85, pool));
#endif
  color = vec4(lit, 1.0);
}
