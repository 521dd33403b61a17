// The sky with what is sharp in it: the sun or the moon, and stars.
#include <sky>
#include <cell_hash>
#include <far_land>

in vec3 v_direction;
uniform float u_stars;   // their brightness
uniform float u_lowest;  // the sky is hidden below directions of this height
layout(location = 0) out vec4 color;

const float kStarCells = 34.0;    // along each side of a cube's face
const float kStarsPerCell = 0.62;
const float kStarRad = 0.0011;

// A star in some of the cells of a cube's face. No smaller than a pixel, and dimmer instead, so that it does not flicker as the view turns.
vec3 starLight(vec3 direction, float pixel_rad) {
  vec3 size = abs(direction);
  float side = max(size.x, max(size.y, size.z));
  int axis = side == size.x ? 0 : side == size.y ? 1 : 2;
  vec2 face = (axis == 0 ? direction.yz : axis == 1 ? direction.zx : direction.xy) / side;
  float toward = direction[axis] > 0.0 ? 3.0 : 0.0;
  vec2 at = (0.5 * face + 0.5) * kStarCells;
  vec2 cell = floor(at) + 71.0 * (float(axis) + toward);
  if (cellHash(cell) > kStarsPerCell) return vec3(0.0);
  vec2 place = 0.15 + 0.7 * vec2(cellHash(cell + 17.0), cellHash(cell + 31.0));
  // Angle to the star; cells are smaller toward the corners of a face.
  float away_rad = length(fract(at) - place) * (2.0 / kStarCells) * side * side;
  float radius_rad = max(kStarRad, 1.1 * pixel_rad);
  float shown = 1.0 - smoothstep(0.0, radius_rad, away_rad);
  float bright = cellHash(cell + 47.0);
  bright *= bright;
  bright = 0.03 + 0.9 * bright * bright * bright;
  vec3 tint = mix(vec3(1.0, 0.82, 0.62), vec3(0.72, 0.84, 1.0), cellHash(cell + 59.0));
  return tint * (bright * shown * kStarRad * kStarRad / (radius_rad * radius_rad));
}

void main() {
  vec3 direction = normalize(v_direction);
  color = vec4(0.0, 0.0, 0.0, 1.0);
  if (direction.y < u_lowest) return;
  // The disc, and around it the light that air and lens spread.
  float toward_sun = max(dot(direction, u_sun_direction), 0.0);
  float sun = u_sun_sharp * (12.0 * smoothstep(0.99986, 0.99996, toward_sun) + 1.6 * pow(toward_sun, 3000.0) + 0.35 * pow(toward_sun, 250.0));
  vec4 sky = texture(u_sky, direction);
  sky.rgb += u_sun_light * sun;
  if (u_stars > 0.0) sky.rgb += u_stars * sky.a * starLight(direction, 0.6 * length(fwidth(direction)));
  float soft = 0.7 * fwidth(direction.y);
  if (u_lowest > -1.0 && direction.y < kFarLandTop) sky.rgb = withFarLand(sky.rgb, direction, soft);
  color = vec4(sky.rgb, 1.0);
}
