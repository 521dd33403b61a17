// Include: the shore of water that moves over its ground, from shore/shore_pass.ts.
#include <bicubic>
uniform sampler2D u_shore;

// Depth over the bed (m; below 0: dry), wetness of the ground, foam.
vec3 shoreAt(vec2 at, vec2 extent_m) { return smoothTexel(u_shore, at / extent_m + 0.5).rgb; }

// Share of the simulated shore: 0 outside the water's rectangle, where only the still water tells what is wet.
float simulatedShore(vec2 at, vec2 extent_m) {
  vec2 inside_m = 0.5 * extent_m - abs(at);
  return clamp(min(inside_m.x, inside_m.y) / (0.04 * max(extent_m.x, extent_m.y)), 0.0, 1.0);
}
