// A small parameter block, and a line that fails to compile when a test asks for it.
layout(std140, binding = 0) uniform Check {
  uint item_count;
  float gain;
  vec4 unused_m;
  float tail_s[2];
} check;

#ifdef BREAK_ON_REQUEST
float broken() { return no_such_name; }
#endif
