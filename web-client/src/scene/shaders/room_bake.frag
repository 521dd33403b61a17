// Bakes a photographer's studio into one face of the cube: a backdrop without seams that is white low behind the water and blue-grey above and at the
// sides, and a soft box overhead. Against white one sees what water absorbs, and mirrored white beside grey gives its surface a shape.

in vec3 v_direction;
uniform vec3 u_room_light;  // relative to noon
layout(location = 0) out vec4 color;

const vec3 kDark = vec3(0.02, 0.06, 0.11), kGrey = vec3(0.16, 0.30, 0.40), kWhite = vec3(0.95, 1.0, 1.0);

void main() {
  vec3 to = normalize(v_direction);
  float behind = 0.5 - 0.5 * to.z / max(length(to.xz), 1e-4);  // 1: behind the water in the usual view
  // The pool of light on the backdrop; it spreads over the floor toward the eye.
  float high = to.y < 0.0 ? -0.55 * to.y : to.y;
  float lit = exp(-20.0 * high * high) * (0.15 + 0.85 * behind * behind * behind * behind);
  vec3 light = mix(kDark, kGrey, smoothstep(0.0, 0.5, lit));
  light = mix(light, kWhite, smoothstep(0.35, 1.0, lit));
  // Overhead, and toward the back.
  vec2 over = (to.xz + vec2(0.0, 0.25)) / max(to.y, 0.2);
  light += vec3(2.0, 2.5, 2.9) * smoothstep(0.75, 0.45, abs(over.x)) * smoothstep(0.55, 0.3, abs(over.y)) * smoothstep(0.45, 0.6, to.y);
  color = vec4(light * u_room_light, 1.0);
}
