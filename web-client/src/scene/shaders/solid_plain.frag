// Boats, rocks, walls and the bed in the plain tiers: the light of the vertices (solid_plain.glsl), wet below a sharp line, and the lace of
// the swash (SHORE).
in vec3 v_light;
in vec2 v_wet;
in vec4 v_leaves;
uniform sampler2D u_noise;
#ifdef SHORE
in vec3 v_world;
in vec2 v_shore;
uniform float u_grain_m;  // size of one tile of the noise
#endif
layout(location = 0) out vec4 color;

void main() {
  float wet = 1.0 - smoothstep(0.6, 1.0, v_wet.x);
#ifdef SHORE
  wet = max(wet, smoothstep(0.2, 0.4, v_shore.x));
#endif
  vec3 light = v_light * (1.0 - v_wet.y * wet);
  // The outline of a clump is torn where one looks along it.
  float leaf = textureLod(u_noise, v_leaves.xy, 0.0).r;
  if (v_leaves.w < 0.55 - 0.65 * leaf) discard;
  light *= 1.0 + v_leaves.z * (0.9 * leaf - 0.4);
#ifdef SHORE
  if (v_shore.y > 0.02) {
    float lace = textureLod(u_noise, v_world.xz / (2.2 * u_grain_m), 0.0).r;
    light = mix(light, vec3(0.92), 0.8 * smoothstep(1.0 - v_shore.y, 1.12 - v_shore.y, lace + 0.12));
  }
#endif
  color = vec4(light, 1.0);
}
