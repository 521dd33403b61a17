// Include: the sky's light. u_sky holds the baked dome without the sun; shaders that show it sharp add the sun.
uniform samplerCube u_sky;
uniform vec3 u_sun_direction;

const vec3 kSunColor = vec3(1.0, 0.90, 0.74);

vec3 skyLight(vec3 direction) { return texture(u_sky, direction).rgb; }

// Linear light → display: a shoulder that reaches white at about 4, then gamma 2. Divisions and a square root only:
// exponentials cost software renderers a third of the frame.
vec3 toDisplay(vec3 linear) {
  vec3 x = linear * 1.9;
  return sqrt(clamp(x * (1.0 + x / 9.0) / (1.0 + x), 0.0, 1.0));
}
