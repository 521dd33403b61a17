// A patch of foam from above: strongest in its middle. Or what is around a hull: foam at its outline, and in the second channel the share of
// the sky's light that it takes from the water.
flat in float v_strength;
flat in vec4 v_hull;
flat in float v_radius_m;
layout(location = 0) out vec4 froth;

// Reach of foam from a hull's side at its stem and at its transom, in halves of the beam: it is thrown out at the bow and spreads on the way
// aft. Reach of the shade, m, and the light that is missing at the side.
const vec2 kFoamBeams = vec2(0.45, 0.9);
const float kShadeM = 0.3, kShade = 0.45;
// The wash astern of a fast hull: where it begins to fade and ends, m behind the transom, and to each side, in halves of the beam; it
// begins so far before the transom, m.
const vec2 kWashM = vec2(0.15, 0.5), kWashBeams = vec2(0.5, 1.1);
const float kUnderM = 0.2;

// Distance from the waterline of a hull, m; below 0 inside. `along_m`: from its middle, ahead and to the side.
float outsideHull(vec2 along_m) {
  float from_widest = along_m.x / v_hull.z + 0.1;
  // Full aft, pointed at the stem.
  float half_m = v_hull.w * (from_widest < 0.0 ? 1.0 - 0.2 * from_widest * from_widest : max(1.0 - 0.83 * from_widest * from_widest, 0.0));
  vec2 away_m = vec2(abs(along_m.x) - v_hull.z, along_m.y - half_m);
  return length(max(away_m, 0.0)) + min(max(away_m.x, away_m.y), 0.0);
}

void main() {
  vec2 at = gl_PointCoord * 2.0 - 1.0;
  if (v_hull.z > 0.0) {
    vec2 at_m = vec2(at.x, -at.y) * v_radius_m;
    vec2 along_m = vec2(dot(at_m, v_hull.xy), abs(dot(at_m, vec2(-v_hull.y, v_hull.x))));
    float outside_m = outsideHull(along_m), astern_m = -along_m.x - v_hull.z;
    float wash = v_strength * v_strength * step(-kUnderM, astern_m) * (1.0 - smoothstep(kWashM.x, kWashM.y, astern_m)) * (1.0 - smoothstep(kWashBeams.x, kWashBeams.y, along_m.y / v_hull.w));
    float foam_m = v_strength * v_hull.w * mix(kFoamBeams.y, kFoamBeams.x, clamp(0.5 + 0.5 * along_m.x / v_hull.z, 0.0, 1.0));
    float near = clamp(1.0 - outside_m / foam_m, 0.0, 1.0);
    froth = vec4(max(v_strength * near * near, wash), kShade * (1.0 - smoothstep(-0.1, kShadeM, outside_m)), 0.0, 1.0);
    return;
  }
  float away = dot(at, at);
  if (away > 1.0) discard;
  froth = vec4(v_strength * (1.0 - away) * (1.0 - away), 0.0, 0.0, 1.0);
}
