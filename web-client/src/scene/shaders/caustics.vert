// A grid of the surface, each vertex moved to where its sunlight arrives at a depth. Drawn in the coordinates in which that light would
// have crossed level water, so that still water gives the grid itself.
#include <bicubic>
in vec3 position;  // x, z in -1/2..1/2 over the square
uniform sampler2D u_field;
uniform vec3 u_sun_direction;
uniform vec2 u_extent_m;  // length and width of the water
uniform float u_deep_m;   // of the layer, below the still water
uniform float u_reach;    // size of the grid in sides: light comes in from beside the square
// TILE: the ripples alone, over their tile, so steep as to focus the light at the floor.
#ifdef RIPPLES
#include <ripples>
uniform float u_gain;
#endif
out vec2 v_from_m;

void main() {
  v_from_m = position.xz * (u_reach * u_extent_m);
#ifdef TILE
  vec4 field = vec4(0.0, u_gain * textureLod(u_ripples, v_from_m / u_extent_m, 1.0).gb, 0.0);
#else
  vec4 field = smoothTexel(u_field, v_from_m / u_extent_m + 0.5);
#ifdef RIPPLES
  // Those that the grid resolves.
  field.gb += textureLod(u_ripples, v_from_m / u_tiles_m.y, 2.0).gb;
#endif
#endif
  vec3 bent = refract(-u_sun_direction, normalize(vec3(-field.g, 1.0, -field.b)), 0.75);
  vec3 level = refract(-u_sun_direction, vec3(0.0, 1.0, 0.0), 0.75);
  vec2 at = v_from_m + bent.xz / max(-bent.y, 0.2) * max(u_deep_m + field.r, 0.0) - level.xz / max(-level.y, 0.2) * u_deep_m;
  gl_Position = vec4(2.0 * at / u_extent_m, 0.0, 1.0);
}
