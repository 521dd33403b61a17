// Slopes of one ring: two or three short waves behind its front, which travels at about 0.3 m/s and fades.
in vec2 v_at_m;
flat in float v_age;
layout(location = 0) out vec4 slopes;  // along x and z

const float kFrontM = 0.25;    // of the front at the end of its life
const float kLengthM = 0.045;  // of its waves
const float kWidthM = 0.07;
const float kSlope = 0.7;

void main() {
  float away_m = length(v_at_m);
  float behind_m = kFrontM * v_age - away_m;
  float across = behind_m / kWidthM * 2.0 - 1.0;
  float envelope = max(1.0 - across * across, 0.0);
  float fading = (1.0 - v_age) * (1.0 - v_age);
  float slope = kSlope * fading * envelope * envelope * sin(6.2832 * behind_m / kLengthM);
  slopes = vec4(slope * v_at_m / max(away_m, 1e-3), 0.0, 0.0);
}
