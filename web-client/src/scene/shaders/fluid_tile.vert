// A quad for each marked tile of the screen; unmarked tiles have no area. Screen passes over the fluid use it instead of one large
// triangle, so that they cost what the fluid covers.
in vec3 position;  // tile column and row; corner 0..3
uniform sampler2D u_tiles;
uniform vec2 u_tiles_count;  // may end within a tile
out vec2 v_uv;

void main() {
  ivec2 tile = ivec2(position.xy);
  bool is_marked = texelFetch(u_tiles, tile, 0).r > 0.0;
  int corner = int(position.z);
  vec2 at = position.xy + (is_marked ? vec2(corner & 1, corner >> 1) : vec2(0.0));
  v_uv = at / u_tiles_count;
  gl_Position = vec4(v_uv * 2.0 - 1.0, 0.0, 1.0);
}
