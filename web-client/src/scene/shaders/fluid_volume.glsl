// Include: the volume that the particles fill, as horizontal slices side by side in one texture (fluid_volume.frag).
uniform sampler2D u_volume;     // density over that at rest, the white part of it, the part that moves fast
uniform vec3 u_volume_min_m;
uniform vec3 u_volume_max_m;
uniform vec3 u_cells_count;     // along x, y, z
uniform float u_cell_m;
uniform float u_slices_per_row;

// The density at the surface: that of a filament of particles.
const float kSurface = 0.36;

// First texel of a slice.
vec2 sliceOrigin(float slice) { return vec2(mod(slice, u_slices_per_row), floor(slice / u_slices_per_row)) * u_cells_count.xz; }

vec3 volumeAt(vec3 at_m) {
  vec3 at = (at_m - u_volume_min_m) / u_cell_m;
  vec2 xz = clamp(at.xz, vec2(0.5), u_cells_count.xz - 0.5);
  float y = clamp(at.y - 0.5, 0.0, u_cells_count.y - 1.001);
  float low = floor(y);
  vec2 per_texel = 1.0 / vec2(textureSize(u_volume, 0));
  return mix(textureLod(u_volume, (sliceOrigin(low) + xz) * per_texel, 0.0).rgb, textureLod(u_volume, (sliceOrigin(low + 1.0) + xz) * per_texel, 0.0).rgb, y - low);
}

// Lengths of the ray at which it enters the volume and leaves it.
vec2 throughVolume(vec3 from, vec3 ray) {
  ray = mix(vec3(1e-6), ray, step(vec3(1e-6), abs(ray)));
  vec3 a = (u_volume_min_m - from) / ray, b = (u_volume_max_m - from) / ray;
  vec3 near = min(a, b), far = max(a, b);
  return vec2(max(max(near.x, near.y), near.z), min(min(far.x, far.y), far.z));
}

// The outward normal of the volume's nearest side.
vec3 sideAt(vec3 at_m) {
  vec3 half_m = 0.5 * (u_volume_max_m - u_volume_min_m);
  vec3 away_m = at_m - u_volume_min_m - half_m;
  vec3 left_m = half_m - abs(away_m);
  vec3 nearest = step(left_m, vec3(min(left_m.x, min(left_m.y, left_m.z))));
  return normalize(nearest * sign(away_m));
}
