// Include, after sky.glsl: what the water of a pool or a tank meets. The garden around it, as the water mirrors it: the limits are those of
// gardenReach() in landscape/garden.ts. And what stands in the water, at which it climbs.

// Colour of shrubs and trees that are not on the screen, and half the height of the fade from their tops to the sky.
const vec3 kShrubs = vec3(0.06, 0.11, 0.05);
const float kTreetops = 0.07;

// The sky in a direction behind shrubs and trees that are not on the screen: crowns of several sizes along the horizon.
vec3 behindShrubs(vec3 sky, vec3 direction) {
  float top = 0.15 + 0.05 * sin(dot(direction.xz, vec2(5.0, 3.0))) + 0.035 * sin(dot(direction.xz, vec2(7.0, -11.0))) + 0.02 * sin(dot(direction.xz, vec2(23.0, 19.0)));
  return mix(kShrubs * (u_ambient_up + 0.5 * u_sun_light), sky, mix(0.2, 1.0, smoothstep(top - kTreetops, top + kTreetops, direction.y)));
}

// Share of the picture in what is mirrored from this position on it. It falls slowly toward the edges: what is beyond them has the colours
// of the sky, and a border between the two would be seen.
float pictureShare(vec2 uv) {
  vec2 edge = smoothstep(0.5, 0.3, abs(uv - 0.5));
  return edge.x * edge.y;
}

// Where a ray meets the upright sides of a box.
vec3 atSides(vec3 from, vec3 direction, vec2 half_m) {
  vec2 safe = mix(vec2(1e-6), direction.xz, step(1e-6, abs(direction.xz)));
  vec2 along_m = max((half_m - from.xz) / safe, (-half_m - from.xz) / safe);
  return from + direction * min(along_m.x, along_m.y);
}

// Where a ray that leaves a pool of this size meets the border of the garden.
vec3 atBorder(vec3 from, vec3 direction, vec2 extent_m) {
  return atSides(from, direction, 0.5 * extent_m + clamp(0.72 * max(extent_m.x, extent_m.y), 3.6, 8.5));
}

// Reach of the bright line where the water climbs a solid, along the ray, m, and the most of its light.
const float kClimbingM = 0.025, kClimbingLight = 0.25;

// Share of the line's light, where the solid is `solid_m` behind the surface. None where that jumps from pixel to pixel: the line would be
// a row of dashes.
float climbingShare(float solid_m) {
  float step_m = fwidth(solid_m);
  return kClimbingLight * (1.0 - smoothstep(0.4, 1.0, solid_m / (kClimbingM + 0.7 * step_m))) * (1.0 - smoothstep(0.02, 0.08, step_m));
}
