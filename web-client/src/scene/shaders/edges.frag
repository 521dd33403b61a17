// The picture with smooth outlines (after Lottes, FXAA 3.11, 2011): where the brightness steps, the ends of the step are searched along it, and
// the pixel is mixed with the one across it by how near the end is.
in vec2 v_uv;
uniform sampler2D u_picture;
uniform vec2 u_texel;
layout(location = 0) out vec4 color;

const float kLeastStep = 0.04;       // of brightness
const float kLeastStepShare = 0.12;  // of the brightest neighbour
const int kSearchSteps = 8;
const float kSubpixel = 0.5;         // by which single pixels are mixed with their neighbours

float bright(vec2 uv) { return dot(textureLod(u_picture, uv, 0.0).rgb, vec3(0.299, 0.587, 0.114)); }

void main() {
  vec3 here = textureLod(u_picture, v_uv, 0.0).rgb;
  float m = dot(here, vec3(0.299, 0.587, 0.114));
  float n = bright(v_uv + vec2(0.0, u_texel.y)), s = bright(v_uv - vec2(0.0, u_texel.y));
  float e = bright(v_uv + vec2(u_texel.x, 0.0)), w = bright(v_uv - vec2(u_texel.x, 0.0));
  float high = max(m, max(max(n, s), max(e, w)));
  float range = high - min(m, min(min(n, s), min(e, w)));
  color = vec4(here, 1.0);
  if (range < max(kLeastStep, kLeastStepShare * high)) return;
  float ne = bright(v_uv + u_texel), sw = bright(v_uv - u_texel);
  float nw = bright(v_uv + vec2(-u_texel.x, u_texel.y)), se = bright(v_uv + vec2(u_texel.x, -u_texel.y));
  float mean = (2.0 * (n + s + e + w) + ne + nw + se + sw) / 12.0;
  float single = smoothstep(0.0, 1.0, clamp(abs(mean - m) / range, 0.0, 1.0));
  float blend = single * single * kSubpixel;
  bool is_level = abs(nw + sw - 2.0 * w) + 2.0 * abs(n + s - 2.0 * m) + abs(ne + se - 2.0 * e) >= abs(nw + ne - 2.0 * n) + 2.0 * abs(w + e - 2.0 * m) + abs(sw + se - 2.0 * s);
  float before = is_level ? s : w, after = is_level ? n : e;
  vec2 across = is_level ? vec2(0.0, u_texel.y) : vec2(u_texel.x, 0.0);
  if (abs(before - m) > abs(after - m)) {
    across = -across;
    after = before;
  }
  // Along the step, half a pixel off its middle, until the brightness is no longer that of the step.
  vec2 along = is_level ? vec2(u_texel.x, 0.0) : vec2(0.0, u_texel.y);
  float middle = 0.5 * (m + after), least = 0.25 * abs(after - m);
  vec2 on = v_uv + 0.5 * across;
  vec2 away = vec2(0.0), ends = vec2(0.0);  // backward, forward: pixels, and brightness beside the step's
  for (int side = 0; side < 2; ++side) {
    float reach = 0.0;
    for (int i = 0; i < kSearchSteps; ++i) {
      reach += i < 4 ? 1.0 : 2.0;
      ends[side] = bright(on + (side == 0 ? -reach : reach) * along) - middle;
      if (abs(ends[side]) >= least) break;
    }
    away[side] = reach;
  }
  float end = away.x < away.y ? ends.x : ends.y;
  // Only on the side of the step that ends there.
  if ((m < middle) != (end < 0.0)) blend = max(blend, 0.5 - min(away.x, away.y) / (away.x + away.y));
  color.rgb = textureLod(u_picture, v_uv + blend * across, 0.0).rgb;
}
