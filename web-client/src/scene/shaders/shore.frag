// The level of the water → what the shore shows: depth over the bed (m, negative on dry ground: bilinear, it is 0 at the waterline),
// wetness of the ground, and foam of the swash.
// Reads u_level in units of u_unit_m, u_cells (ground with obstacles and without them [m]), wetness and foam of two frames.

uniform isampler2D u_level;
uniform sampler2D u_cells;
uniform float u_unit_m;
uniform vec2 u_cells_per_texel;
uniform sampler2D u_wet_from;
uniform sampler2D u_wet_to;
uniform float u_wet_mix;

layout(location = 0) out vec4 shore;

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy * u_cells_per_texel);
  float deep_m = float(texelFetch(u_level, at, 0).r) * u_unit_m - texelFetch(u_cells, at, 0).g;
  vec2 uv = (vec2(at) + 0.5) / vec2(textureSize(u_level, 0));
  shore = vec4(deep_m, mix(textureLod(u_wet_from, uv, 0.0).rg, textureLod(u_wet_to, uv, 0.0).rg, u_wet_mix), 0.0);
}
