// Include: depth of the bed; negative on land. GROUND: of a scene with a bed, from a texture over the water. Otherwise it rises toward
// sides with a beach, in the order +x, -x, +z, -z.
#ifdef GROUND
uniform sampler2D u_ground;  // [m]

float bedDepth(vec2 at, vec2 extent_m, float depth_m) {
  return textureLod(u_ground, at / extent_m + 0.5, 0.0).r;
}
#else
uniform vec4 u_beach_width_m;
uniform vec4 u_shore_depth_m;  // the scene's depth where there is no beach

float bedDepth(vec2 at, vec2 extent_m, float depth_m) {
  vec4 inside_m = 0.5 * extent_m.xxyy - vec4(at.x, -at.x, at.y, -at.y);
  vec4 depth = mix(u_shore_depth_m, vec4(depth_m), clamp(inside_m / u_beach_width_m, 0.0, 1.0));
  return min(min(depth.x, depth.y), min(depth.z, depth.w));
}
#endif
