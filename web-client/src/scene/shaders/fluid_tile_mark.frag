// Marks the tiles of the screen that a particle touches.
layout(location = 0) out vec4 mark;

void main() { mark = vec4(1.0); }
