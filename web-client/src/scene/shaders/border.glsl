// Include: the garden around a pool, as water mirrors it. The limits are those of gardenReach() in landscape/garden.ts.

// Colour of shrubs and trees that are not on the screen, and the heights of directions in which they give way to the sky.
const vec3 kShrubs = vec3(0.09, 0.15, 0.05);
const vec2 kShrubsTop = vec2(0.06, 0.20);

// Where a ray that leaves a pool of this size meets the border of the garden.
vec3 atBorder(vec3 from, vec3 direction, vec2 extent_m) {
  vec2 half_m = 0.5 * extent_m + clamp(0.72 * max(extent_m.x, extent_m.y), 3.6, 8.5);
  vec2 safe = mix(vec2(1e-6), direction.xz, step(1e-6, abs(direction.xz)));
  vec2 along_m = max((half_m - from.xz) / safe, (-half_m - from.xz) / safe);
  return from + direction * min(along_m.x, along_m.y);
}
