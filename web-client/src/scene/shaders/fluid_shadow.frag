// Share of the sunlight that reaches the floor below the fluid, multiplied into the picture: absorbed along the thickness, and focused
// or spread by it as by a thin lens. The light's displacement is proportional to the slope of the thickness, so the share changes with
// the Laplacian of the thickness: dark outside an edge, bright inside it.
// Reads u_thickness (thickness along the sunlight [m]).
#include <water_optics>

in vec2 v_uv;
uniform sampler2D u_thickness;
uniform float u_shaded_m;
uniform float u_apart_m;      // between samples: about the particles' spacing, below which the thickness only shows the particles
uniform float u_colour_ratio;
layout(location = 0) out vec4 color;

void main() {
  float step_uv = u_apart_m / u_shaded_m;
  float middle_m = texture(u_thickness, v_uv).r;
  float around_m = 0.25 * (texture(u_thickness, v_uv + vec2(step_uv, 0.0)).r + texture(u_thickness, v_uv - vec2(step_uv, 0.0)).r +
                           texture(u_thickness, v_uv + vec2(0.0, step_uv)).r + texture(u_thickness, v_uv - vec2(0.0, step_uv)).r);
  float mean_m = 0.5 * (middle_m + around_m);
  float focus = clamp(1.0 + 1.3 * (middle_m - around_m) / u_apart_m, 0.45, 1.6);
  // Light of the sky remains where the sun is refracted away.
  vec3 light = 0.35 + 0.65 * focus * exp(-u_loss_per_m * mean_m * u_colour_ratio);
  color = vec4(light * mix(1.0, 0.8, min(mean_m / u_apart_m, 1.0)), 1.0);
}
