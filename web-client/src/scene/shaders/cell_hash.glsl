// Include: a fixed pseudo-random number in [0, 1) for each integer cell.
float cellHash(vec2 cell) {
  ivec2 whole = ivec2(cell);
  uint mixed = uint(whole.x) * 2654435769u ^ uint(whole.y) * 2246822507u;
  mixed ^= mixed >> 15u;
  mixed *= 739982445u;
  mixed ^= mixed >> 12u;
  return float(mixed >> 8u) / 16777216.0;
}
