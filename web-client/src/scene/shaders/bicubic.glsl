// Include: a texture as a smooth surface through its texels (cubic B-spline), so that the grid does not show in slopes, foam and outlines.
// Four bilinear samples stand for sixteen texels (Sigg & Hadwiger 2005). `level`: of the mip levels. PLAIN: bilinear.
#ifndef BICUBIC
#define BICUBIC
vec4 smoothTexel(sampler2D map, vec2 uv, int level) {
#ifdef PLAIN
  return textureLod(map, uv, float(level));
#else
  vec2 size = vec2(max(textureSize(map, 0) >> level, 1));
  vec2 at = uv * size - 0.5;
  vec2 f = fract(at);
  vec2 f2 = f * f, f3 = f2 * f;
  vec2 w0 = (1.0 - f) * (1.0 - f) * (1.0 - f) / 6.0;
  vec2 w1 = (4.0 - 6.0 * f2 + 3.0 * f3) / 6.0;
  vec2 w3 = f3 / 6.0;
  vec2 low = w0 + w1, high = 1.0 - low;
  vec2 centre = at - f + 0.5;
  vec4 places = vec4(centre - 1.0 + w1 / low, centre + 1.0 + w3 / high) / size.xyxy;
  return mix(mix(textureLod(map, places.zw, float(level)), textureLod(map, places.xw, float(level)), low.x),
             mix(textureLod(map, places.zy, float(level)), textureLod(map, places.xy, float(level)), low.x), low.y);
#endif
}

vec4 smoothTexel(sampler2D map, vec2 uv) { return smoothTexel(map, uv, 0); }
#endif
