// A patch of foam from above: strongest in its middle. Or what is around a hull: foam at its outline, and in the second channel the share of
// the sky's light that it takes from the water.
flat in float v_strength;
flat in vec4 v_hull;
flat in float v_radius_m;
layout(location = 0) out vec4 froth;

// Reach of foam and shade around a hull, m, and the light that is missing at its side.
const float kFoamM = 0.3, kShadeM = 0.45, kShade = 0.55;
// How far the wash astern reaches behind a fast hull, m, and its width in beams.
const float kWashM = 0.5, kWashBeams = 0.5;

// Distance from the waterline of a hull, m; below 0 inside. `at_m`: from its middle.
float outsideHull(vec2 at_m) {
  vec2 along = vec2(dot(at_m, v_hull.xy), abs(dot(at_m, vec2(-v_hull.y, v_hull.x))));
  float from_widest = along.x / v_hull.z + 0.1;
  // Full aft, pointed at the stem.
  float half_m = v_hull.w * (from_widest < 0.0 ? 1.0 - 0.2 * from_widest * from_widest : max(1.0 - 0.83 * from_widest * from_widest, 0.0));
  vec2 away_m = vec2(abs(along.x) - v_hull.z, along.y - half_m);
  return length(max(away_m, 0.0)) + min(max(away_m.x, away_m.y), 0.0);
}

void main() {
  vec2 at = gl_PointCoord * 2.0 - 1.0;
  if (v_hull.z > 0.0) {
    vec2 at_m = vec2(at.x, -at.y) * v_radius_m;
    float outside_m = outsideHull(at_m);
    vec2 astern_m = vec2(-dot(at_m, v_hull.xy) - v_hull.z, abs(dot(at_m, vec2(-v_hull.y, v_hull.x))));
    float wash = v_strength * v_strength * step(-0.2, astern_m.x) * (1.0 - smoothstep(0.3, 1.0, astern_m.x / kWashM)) * (1.0 - smoothstep(0.5, 1.1, astern_m.y / v_hull.w));
    froth = vec4(max(v_strength * (1.0 - smoothstep(0.0, kFoamM, outside_m)), wash), kShade * (1.0 - smoothstep(-0.1, kShadeM, outside_m)), 0.0, 1.0);
    return;
  }
  float away = dot(at, at);
  if (away > 1.0) discard;
  froth = vec4(v_strength * (1.0 - away) * (1.0 - away), 0.0, 0.0, 1.0);
}
