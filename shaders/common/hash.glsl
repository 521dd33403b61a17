// Random numbers from integers, the same on every device: PCG-3D (Jarzynski & Olano 2020).
#ifndef SPINDRIFT_HASH
#define SPINDRIFT_HASH

uvec3 hashed(uvec3 v) {
  v = v * 1664525u + 1013904223u;
  v.x += v.y * v.z;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  v ^= v >> 16u;
  v.x += v.y * v.z;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  return v;
}

/// Three numbers in [0, 1).
vec3 random3(uvec3 v) { return vec3(hashed(v) >> 8u) * (1.0 / 16777216.0); }

#endif
