// Include: ripples, waves too short for the simulation's grid (sea/ripples.ts).
uniform sampler2D u_ripples;  // elevation (m), slope along x, slope along z; a repeating tile
uniform vec2 u_tiles_m;       // of the swell and of the ripples

const float kFinerRipples = 2.9;
const mat2 kTurnedRipples = mat2(0.8, 0.6, -0.6, 0.8);

// Slopes. Two more copies, each turned and finer, so that the tile does not show and that there is detail near the camera.
vec2 rippleSlopes(vec2 at) {
  at /= u_tiles_m.y;
  vec2 finer_at = kTurnedRipples * at * kFinerRipples;
  vec2 finest = texture(u_ripples, kTurnedRipples * finer_at * kFinerRipples).gb * kTurnedRipples;
  vec2 finer = (texture(u_ripples, finer_at).gb + finest) * kTurnedRipples;
  return 0.58 * (texture(u_ripples, at).gb + finer);
}
