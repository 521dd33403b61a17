// Include: ripples, waves too short for the simulation's grid (sea/ripples.ts).
uniform sampler2D u_ripples;  // elevation (m), slope along x, slope along z; a repeating tile
uniform vec2 u_tiles_m;       // of the swell and of the ripples

const float kFinerRipples = 2.9;
const mat2 kTurnedRipples = mat2(0.8, 0.6, -0.6, 0.8);

// Slopes. A second copy, turned and finer, so that the tile does not show and that there is detail near the camera.
vec2 rippleSlopes(vec2 at) {
  vec2 finer = texture(u_ripples, kTurnedRipples * at * kFinerRipples / u_tiles_m.y).gb;
  return 0.71 * (texture(u_ripples, at / u_tiles_m.y).gb + finer * kTurnedRipples);
}
