// Include in a fragment shader: a puff of spray, fine drops drawn out along their flight in a haze of finer ones.
uniform sampler2D u_noise;

// Tiles of the noise per m, along the flight and across, coarse and fine.
const vec4 kTilesPerM = vec4(2.4, 5.0, 5.2, 11.0);
// Height of the noise over which there is a drop, at first and at last.
const vec2 kDropAt = vec2(0.7, 1.15);
const float kHaze = 0.42;

// Returns how much it hides of what is behind it. `at`: -1..1 over the point; `flight`: unit direction; `puff`: as v_puff of drop.glsl.
float puffAt(vec2 at, vec2 flight, vec4 puff) {
  vec2 along_m = puff.w * vec2(dot(at, flight), dot(at, vec2(-flight.y, flight.x)));
  float coarse = texture(u_noise, puff.xy + kTilesPerM.xy * along_m).r, fine = texture(u_noise, puff.yx + kTilesPerM.zw * along_m).r;
  float left = 1.0 - dot(at, at);
  float drop_at = mix(kDropAt.x, kDropAt.y, puff.z);
  float drops = smoothstep(drop_at, drop_at + 0.25, 1.0 - 0.5 * (coarse + fine) + 0.35 * left);
  return max(drops * smoothstep(0.0, 0.3, left), kHaze * (1.0 - puff.z) * left * left);
}
