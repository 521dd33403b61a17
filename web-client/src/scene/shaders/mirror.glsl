// Include in water.frag, behind its uniforms: what the surface mirrors. OPEN_SEA, SKIRT, MIRROR as there.
#ifndef OPEN_SEA
#include <border>
#endif
uniform vec3 u_veiled_sky[3];  // zenith, middle, horizon
uniform vec3 u_glow;
// Share of the mirrored sky without single clouds: waves finer than the ripples blur them.
#ifdef OPEN_SEA
const float kVeiledShare = 0.7;
#else
const float kVeiledShare = 0.85;
#endif

// The colours of sky_bake.frag with the clouds' mean: on ripples clouds cannot be made out, and a cube map is slow to read.
vec3 veiledSky(vec3 direction) {
  vec3 sky = mix(u_veiled_sky[1], u_veiled_sky[0], smoothstep(0.12, 0.75, direction.y));
  sky = mix(u_veiled_sky[2], sky, smoothstep(-0.02, 0.20, direction.y));
  float toward_sun = max(dot(direction, u_sun_direction), 0.0);
  toward_sun *= toward_sun;
  sky += 0.08 * u_glow * toward_sun * toward_sun;
#ifndef OPEN_SEA
  sky = behindShrubs(sky, direction);
#endif
  return sky;
}

// The sky as a surface mirrors it whose slopes have this variance within a pixel.
vec3 mirroredSky(vec3 direction, float variance) {
  // Mip levels whose texels are as wide as the reflection: twice the slopes, and the turn of the mirror over a pixel.
  vec3 turn = fwidth(direction);
  float spread = float(textureSize(u_sky, 0).x) * (1.3 * sqrt(variance) + 0.5 * length(turn));
  return mix(textureLod(u_sky, direction, log2(max(spread, 1.0))).rgb, veiledSky(direction), kVeiledShare);
}

#if defined(MIRROR) && !defined(SKIRT)
uniform mat4 projectionMatrix;
const int kMirrorSteps = MIRROR;
const int kMirrorHalvings = 4;

// Distance (m) of a point behind what the screen shows there; a large negative number if it is off the screen.
float behindScreen(vec3 at, out vec2 uv) {
  vec4 view = viewMatrix * vec4(at, 1.0);
  vec4 clip = projectionMatrix * view;
  uv = clip.xy / clip.w * 0.5 + 0.5;
  if (clip.w <= 0.0 || any(greaterThan(abs(uv - 0.5), vec2(0.5)))) return -1e6;
  return viewZ(texture(u_behind_depth, uv).r) - view.z;
}

#ifndef OPEN_SEA
// Light of the garden and of the sky over it: what the screen shows where the ray meets the border, unless something stands before it.
vec3 gardenLight(vec3 from, vec3 direction, vec3 sky) {
  vec3 at = atBorder(from, direction, u_extent_m);
  vec2 uv;
  float behind_m = behindScreen(at, uv);
  return behind_m < -1e5 || behind_m > 0.5 * distance(at, u_camera_m) ? sky : mix(sky, texture(u_behind, uv).rgb, pictureShare(uv));
}
#endif

// Light that arrives at `from` along `direction`: from a solid if the ray meets one on the screen, else from the sky.
vec3 mirroredLight(vec3 from, vec3 direction, vec3 sky) {
  float reach_m = 0.3 * max(u_extent_m.x, u_extent_m.y);
#ifndef OPEN_SEA
  sky = gardenLight(from, direction, sky);
  // A ray that rises past a pool's walls does not meet the deck, of which the screen shows the upper side.
  reach_m = min(reach_m, 1.02 * wayOut(from, direction));
#endif
  // Of what stands on the screen, whose back is not seen.
  float thick_m = min(1.0, 0.2 * min(u_extent_m.x, u_extent_m.y));
  float before_m = 0.0;
  vec2 uv;
  for (int i = 1; i <= kMirrorSteps; ++i) {
    // Steps grow with the distance: near a hull they have to be short.
    float share = (float(i) - 0.35) / float(kMirrorSteps);
    float along_m = reach_m * share * share;
    float deep_m = behindScreen(from + direction * along_m, uv);
    if (deep_m > 0.0 && deep_m < thick_m + 1.5 * (along_m - before_m)) {
      for (int half_step = 0; half_step < kMirrorHalvings; ++half_step) {
        float middle_m = 0.5 * (before_m + along_m);
        if (behindScreen(from + direction * middle_m, uv) > 0.0) along_m = middle_m;
        else before_m = middle_m;
      }
      behindScreen(from + direction * along_m, uv);
      vec2 edge = smoothstep(0.5, 0.42, abs(uv - 0.5));
      return mix(sky, texture(u_behind, uv).rgb, edge.x * edge.y * (1.0 - share));
    }
    before_m = along_m;
  }
  return sky;
}
#endif
