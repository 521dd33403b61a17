// Surface: a unit grid displaced by the field. Skirt (SKIRT): the four sides, top edge displaced, bottom edge on the floor.
// VERTEX_LIT: for water_plain.frag. LOWERED: drawn below where it is, under the particles that it carries. BEACH: the floor rises toward some sides. OPEN_SEA: the grid continues to the horizon (sea/open_sea.ts).
// UNEVEN: straight crests are drawn uneven. HEAPED: fresh foam lies on the water in heaps.

in vec3 position;  // x, z in -1/2..1/2 over the square; y: 1 on the surface, 0 on the floor
#ifdef SKIRT
in vec3 normal;
out vec3 v_side_normal;
#endif

uniform mat4 viewMatrix;
uniform mat4 projectionMatrix;
uniform sampler2D u_field;
uniform vec2 u_extent_m;  // length and width of the water
uniform float u_depth_m;

#ifdef GLASS
#include <bicubic>
#endif
#ifdef LOWERED
uniform float u_lowered_m;
#endif

#ifdef BEACH
#include <bed>
#endif

#ifdef OPEN_SEA
#include <sea_blend>
out vec2 v_share_away;  // of the simulated water; distance from the square (m)
#endif

#ifdef UNEVEN
out vec2 v_shoreward;  // direction toward shallower water; 0 over a level bed
#endif
out vec3 v_world;
out vec2 v_level_m;  // where it lies before it leans and is raised in heaps
out float v_view_z;
out float v_top_m;
#ifdef HEAPED
uniform sampler2D u_noise;
uniform float u_lace_m;
uniform sampler2D u_froth;
#ifdef FOAM
uniform sampler2D u_foam_from;
uniform sampler2D u_foam_to;
uniform float u_foam_mix;
#endif
#include <billows>
// Height of heaps of foam, in tiles of the lace.
#ifdef GLASS
const float kHeap = 0.14;
out float v_heap_m;
#else
const float kHeap = 0.07;
#endif
// Share of the foam along hulls that raises heaps: their wash is lower than a breaker.
const float kAlongHulls = 0.66;
#endif
#if defined(VERTEX_LIT) && !defined(SKIRT)
#include <water_plain>
#endif

void main() {
#ifdef UNEVEN
  vec4 field = texture(u_field, unevenAt(position.xz * u_extent_m) / u_extent_m + 0.5);
  field.r *= unevenHeight(position.xz * u_extent_m, field.r);
#elif defined(GLASS)
  // Between the samples, which the cut of a tank would show as corners.
  vec4 field = smoothTexel(u_field, position.xz + 0.5);
#else
  vec4 field = texture(u_field, position.xz + 0.5);
#endif
  v_top_m = field.r;
#ifdef OPEN_SEA
  vec2 at = position.xz * u_extent_m;
  float away_m = awayFromWater(at, u_extent_m);
  v_share_away = vec2(simulatedShare(at, u_extent_m), away_m);
  // The grid becomes coarser outside: there the waves are in the normals only.
  float raised = 1.0 - smoothstep(0.12, 0.5, away_m / max(u_extent_m.x, u_extent_m.y));
  float sea_m = raised > 0.0 ? raised * textureLod(u_swell, at / u_tiles_m.x, 0.0).r : 0.0;
  v_top_m = mix(sea_m, v_top_m, v_share_away.x);
#endif
#ifdef LOWERED
  v_top_m -= u_lowered_m;
#endif
  float depth_m = u_depth_m;
#ifdef BEACH
  depth_m = bedDepth(position.xz * u_extent_m, u_extent_m, u_depth_m);
#endif
  v_world = vec3(position.x * u_extent_m.x, mix(-depth_m, max(v_top_m, -depth_m), position.y), position.z * u_extent_m.y);
  v_level_m = v_world.xz;
#ifdef UNEVEN
  v_shoreward = vec2(0.0);
#ifdef BEACH
  const vec2 kStepM = vec2(0.5, 0.0);
  vec2 falling = vec2(bedDepth(at - kStepM, u_extent_m, u_depth_m) - bedDepth(at + kStepM, u_extent_m, u_depth_m),
                      bedDepth(at - kStepM.yx, u_extent_m, u_depth_m) - bedDepth(at + kStepM.yx, u_extent_m, u_depth_m));
  v_shoreward = falling / max(length(falling), 0.05);
  v_world.xz += v_shoreward * leanM(v_top_m);
#endif
#endif
#ifdef HEAPED
  vec2 place = position.xz + 0.5;
  float foam = kAlongHulls * texture(u_froth, place).r;
#ifdef FOAM
  foam = max(foam, mix(texture(u_foam_from, place).r, texture(u_foam_to, place).r, u_foam_mix));
#endif
#ifdef OPEN_SEA
  foam = max(foam * insideSquare(place), crestFoam(field.r, field.a)) * v_share_away.x;
#endif
#ifdef BEACH
  // Thin water ends on the ground.
  foam *= smoothstep(0.02, 0.2, (v_top_m + depth_m) / u_lace_m);
#endif
  float most_m = kHeap * u_lace_m * heapedShare(foam), heap_m = most_m * billowsAt(placeOfFoam(v_level_m, field.gb, v_top_m));
#ifdef GLASS
  // Its mean over the billows: the edge at the glass would have their teeth.
  v_heap_m = 0.75 * most_m;
  v_world.y += heap_m * position.y;
#else
  v_world += heap_m * normalize(vec3(-field.g, 1.0, -field.b));
#endif
#endif
#ifdef SKIRT
  v_side_normal = normal;
#elif defined(VERTEX_LIT)
  preparePlain(field.gb, field.a, depth_m);
#endif
  vec4 view = viewMatrix * vec4(v_world, 1.0);
  v_view_z = view.z;
  gl_Position = projectionMatrix * view;
}
