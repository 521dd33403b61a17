// Include: the sky's light. u_sky holds the baked dome without the sun; shaders that show it sharp add the sun.
// The rest is the light of the hour and the weather (light/light.ts).
uniform samplerCube u_sky;
uniform vec3 u_sun_direction;  // of the sun or the moon, whichever gives the direct light
uniform vec3 u_sun_light;      // on a surface that faces it
uniform vec3 u_sun_below;      // the same below level water
uniform vec3 u_ambient_up;     // light of the sky on surfaces that face up and down
uniform vec3 u_ambient_down;
uniform vec3 u_water_light;    // light that enters the water, relative to noon
uniform float u_sun_sharp;     // share of it that comes from the disc: 0 under clouds
uniform float u_exposure;
uniform bool u_is_displayed;      // solids are drawn for the display instead of as linear light; in the plain tiers

// Light that water mirrors where it climbs the glass of a tank: that from above.
vec3 meniscusLight() { return vec3(0.8, 0.95, 1.0) * u_ambient_up + 0.2 * u_sun_light; }

vec3 skyLight(vec3 direction) { return texture(u_sky, direction).rgb; }

// Linear light → display: a filmic curve with a softer foot, then gamma 2 (docs/light.md). Divisions and a square root only: exponentials
// cost software renderers a third of the frame.
vec3 toDisplay(vec3 linear) {
  vec3 x = linear * (0.86 * u_exposure);
  return sqrt(clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.09), 0.0, 1.0));
}
