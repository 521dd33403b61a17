uniform float u_shade;
layout(location = 0) out vec4 froth;

void main() { froth = vec4(0.0, u_shade, 0.0, 1.0); }
