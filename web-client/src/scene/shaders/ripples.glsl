// Include: ripples, waves too short for the simulation's grid (sea/ripples.ts).
uniform sampler2D u_ripples;  // elevation (m), slope along x, slope along z; a repeating tile
uniform vec2 u_tiles_m;       // of the swell and of the ripples

const float kFinerRipples = 2.9;
// Tiles by which a slope of 1 moves shorter waves.
const float kBentCrests = 0.03;
const mat2 kTurnedRipples = mat2(0.8, 0.6, -0.6, 0.8);

// Slopes. Two more copies, each turned and finer, so that the tile does not show and that there is detail near the camera. Longer waves
// bend the crests of shorter ones: straight crests that cross each other are cloth.
vec2 rippleSlopes(vec2 at) {
  at /= u_tiles_m.y;
  vec2 longer = texture(u_ripples, at).gb;
  vec2 finer_at = kTurnedRipples * (at + kBentCrests * longer) * kFinerRipples;
  vec2 shorter = texture(u_ripples, finer_at).gb;
  vec2 finest = texture(u_ripples, kTurnedRipples * (finer_at + kBentCrests * shorter) * kFinerRipples).gb * kTurnedRipples;
  return 0.58 * (longer + (shorter + finest) * kTurnedRipples);
}
