// Shared: the sky's light. u_sky holds the baked dome without the sun; the sun is added where it may be sharp.
uniform samplerCube u_sky;
uniform vec3 u_sun_direction;

const vec3 kSunColor = vec3(1.0, 0.90, 0.74);

vec3 skyLight(vec3 direction) { return texture(u_sky, direction).rgb; }

vec3 toDisplay(vec3 linear) {
  vec3 mapped = 1.0 - exp(-linear * 1.35);
  vec3 low = mapped * 12.92;
  vec3 high = 1.055 * pow(max(mapped, vec3(0.0031308)), vec3(1.0 / 2.4)) - 0.055;
  return mix(low, high, step(vec3(0.0031308), mapped));
}
