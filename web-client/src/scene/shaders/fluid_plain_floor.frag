// Multiplies what is on the canvas.
in float v_passed;
layout(location = 0) out vec4 color;

void main() { color = vec4(vec3(v_passed), 1.0); }
