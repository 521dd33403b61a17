// One point per particle, read from the 12 bytes of the wire as six u16; the last three hold velocity x | velocity y,
// velocity z | tint, foam | 0. The point's square covers the sphere's silhouette. PLAIN: for particle_plain.frag, one depth per point.
// Points, not instanced quads: software renderers handle each instance like a draw call (measured: 3 times the processor time).
in vec3 position;  // x, z, y as fractions of the bounds
in vec3 a_packed;  // u16 / 65535

uniform mat4 viewMatrix;
uniform mat4 projectionMatrix;
uniform vec3 u_min_m;
uniform vec3 u_max_m;
uniform float u_max_speed_mps;
uniform float u_advance_s;
uniform float u_radius_m;
uniform vec2 u_resolution;
uniform sampler2D u_field;
uniform float u_side_m;
uniform bool u_has_water;

#include <particle_color>
#ifdef PLAIN
#include <sky>
uniform float u_depth_m;
flat out vec3 v_sunlit;
flat out vec3 v_ambient_low;
flat out vec3 v_ambient_high;
flat out float v_radius_px;
#else
flat out vec3 v_center_m;
flat out float v_radius_m;
flat out vec2 v_tint_foam;
flat out float v_world_y_m;
flat out float v_above_m;  // height of the centre over the surface; a large number in a scene without a wave
#endif

float signedByte(uint bits) { return float(int(bits << 24u) >> 24) / 127.0; }

void main() {
  uvec3 words = uvec3(a_packed * 65535.0 + 0.5);
  vec3 velocity = vec3(signedByte(words.x & 255u), signedByte(words.x >> 8u), signedByte(words.y & 255u)) * u_max_speed_mps;
  vec3 center = mix(u_min_m, u_max_m, position.xzy) + velocity * u_advance_s;
  vec2 tint_foam = vec2(float(words.y >> 8u), float(words.z & 255u)) / 255.0;
  float above_m = u_has_water ? center.y - texture(u_field, center.xz / u_side_m + 0.5).r : 1e3;
  float out_of_water = outOfWater(above_m, u_radius_m);
  float foam = foamShare(tint_foam.y, out_of_water);
  float radius_m = u_radius_m * (u_has_water ? mix(1.0, kSprayRadius, foam * out_of_water) : 1.0);
  vec3 center_m = (viewMatrix * vec4(center, 1.0)).xyz;

  float distance_m = length(center_m);
  float ahead_m = -center_m.z;
  if (ahead_m < 1.5 * radius_m) {
    gl_Position = vec4(0.0, 0.0, 2.0, 1.0);
    gl_PointSize = 1.0;
    return;
  }
  gl_Position = projectionMatrix * vec4(center_m, 1.0);
  // Off the axis a sphere's silhouette is longer than wide: its outer half is tan(off + half) - tan(off).
  float off = length(center_m.xy) / ahead_m;
  float half_width = radius_m / sqrt(distance_m * distance_m - radius_m * radius_m);
  float reach = half_width * (1.0 + off * off) / max(1.0 - off * half_width, 0.1);
  gl_PointSize = reach * projectionMatrix[1][1] * u_resolution.y;

#ifdef PLAIN
  v_radius_px = 0.5 * gl_PointSize;
  gl_PointSize += 2.0;
  // Just under the surface the patch is moved behind its sphere, so that the surface covers it; elsewhere in front of it, so that
  // the floor does not cover it.
  float under_skin = (1.0 - out_of_water) * smoothstep(-2.5, -1.2, above_m / u_radius_m);
  vec4 pushed = projectionMatrix * vec4(center_m * (1.0 + mix(-0.8, 1.1, under_skin) * u_radius_m / distance_m), 1.0);
  gl_Position.z = pushed.z / pushed.w * gl_Position.w;
  vec3 lit = particleAlbedo(tint_foam.x, foam, out_of_water) * lightReaching(center.y, u_depth_m, out_of_water);
  v_sunlit = lit * kSunColor * 1.15;
  v_ambient_low = lit * kAmbientBelow * (1.0 + 0.35 * foam);
  v_ambient_high = lit * kAmbientAbove * (1.0 + 0.35 * foam);
#else
  // One pixel more on each side for the soft edge.
  gl_PointSize += 2.0;
  v_center_m = center_m;
  v_radius_m = radius_m;
  v_tint_foam = tint_foam;
  v_world_y_m = center.y;
  v_above_m = above_m;
#endif
}
