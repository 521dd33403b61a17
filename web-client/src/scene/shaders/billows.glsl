// Include: fresh foam lies in heaps, billow upon billow. After u_noise and u_lace_m.

// Size of the largest billows, in tiles of the lace.
const float kBillows = 1.7;

// Their height, 0..1: round domes with narrow valleys.
float billowsAt(vec2 at) {
  float broad = abs(textureLod(u_noise, at.yx / (kBillows * u_lace_m), 3.0).r - 0.5);
  float middle = abs(textureLod(u_noise, at / (0.42 * kBillows * u_lace_m) + 0.37, 3.0).r - 0.5);
  return sqrt(clamp(2.4 * broad + 1.1 * middle, 0.0, 1.0));
}

// How far foam of this `cover` is a heap, 0..1: what has just begun is one, old foam is a network on the water.
float heapedShare(float cover) { return smoothstep(0.45, 0.9, cover); }

// Where foam lies that is not drawn out on steep faces: their height counts as a way along them.
vec2 placeOfFoam(vec2 at, vec2 slopes, float top_m) {
#ifdef UNEVEN
  return at - v_shoreward * top_m;
#elif defined(GLASS)
  return at + top_m * slopes / (0.3 + length(slopes));
#else
  return at;
#endif
}
