// Include in water.frag, behind its uniforms, for the sides of the water (SKIRT): what is seen through them. The ray is refracted at the
// glass and goes to the far glass, to the bed or to the surface, which mirrors it or lets it out. BEACH: the bed is not level.
uniform mat4 projectionMatrix;
const float kSideSteps = 28.0;

// Heights of the water over a position, and of the position over the bed [m].
vec2 heightsAt(vec3 at) {
  float over_m = textureLod(u_field, at.xz / u_extent_m + 0.5, 0.0).r - at.y;
#ifdef BEACH
  return vec2(over_m, at.y + bedDepth(at.xz, u_extent_m, u_depth_m));
#else
  return vec2(over_m, at.y + u_depth_m);
#endif
}

// The light that the picture of the solids has at a position, or at the edge that is nearest to it.
vec3 solidsAt(vec3 at) {
  vec4 clip = projectionMatrix * (viewMatrix * vec4(at, 1.0));
  return textureLod(u_behind, clamp(clip.xy / clip.w * 0.5 + 0.5, 0.001, 0.999), 0.0).rgb;
}

// Light that comes along `to` to a position outside of the water.
vec3 lightAround(vec3 from, vec3 to) {
  float down_m = (from.y + u_depth_m) / max(-to.y, 1e-3);
  return mix(solidsAt(from + to * min(down_m, 30.0)), textureLod(u_sky, vec3(to.x, abs(to.y), to.z), 1.0).rgb, smoothstep(-0.06, 0.0, to.y));
}

// `length_m`: of the way in the water.
vec3 throughSide(vec3 from, vec3 ray, vec3 side, out float length_m) {
  vec3 bent = refract(ray, side, 0.75);
  length_m = 0.0;
  for (int part = 0; part < 2; ++part) {
    float step_m = wayOut(from, bent) / kSideSteps, along_m = 0.0;
    vec2 heights = vec2(1.0), before;
    for (float i = 0.0; i < kSideSteps && min(heights.x, heights.y) > 0.0; ++i) {
      before = heights;
      along_m += step_m;
      heights = heightsAt(from + bent * along_m);
    }
    bool is_surface = heights.x <= 0.0;
    vec2 past = clamp(heights / min(heights - before, -1e-5), 0.0, 1.0) * step(heights, vec2(0.0));
    along_m -= step_m * max(past.x, past.y);
    from += bent * along_m;
    length_m += along_m;
    vec3 outward = vec3(0.0);
    if (is_surface) {
      vec2 slopes = smoothTexel(u_field, from.xz / u_extent_m + 0.5).gb;
      outward = normalize(vec3(-slopes.x, 1.0, -slopes.y));
    } else if (heights.y > 0.01 * u_depth_m) {
      vec2 left_m = 0.5 * u_extent_m - abs(from.xz);
      outward.xz = sign(from.xz) * (left_m.x < left_m.y ? vec2(1.0, 0.0) : vec2(0.0, 1.0));
    } else break;
    vec3 leaving = refract(bent, -outward, 1.333);
    if (dot(leaving, leaving) > 0.0) return lightAround(from, leaving);
    bent = reflect(bent, outward);
    from -= outward * 0.01 * u_depth_m;
  }
  // Not on the edge of the bed, beyond which the picture shows something else.
  vec2 inner_m = 0.5 * u_extent_m - 0.02 * u_extent_m.y;
  from.xz = clamp(from.xz, -inner_m, inner_m);
  return solidsAt(from);
}

// Light in the water of a tank `under_m` below its surface, from above.
float litFromAbove(float under_m) { return 0.7 + 1.5 * exp(-under_m / (0.16 * u_depth_m)); }

// `under_m`: below the surface. The bright line where it meets the glass, over a darker one.
vec3 withMeniscus(vec3 water, float under_m) {
  float lines = under_m / max(0.004 * u_depth_m, 0.8 * fwidth(v_world.y));
  return mix(water * (1.0 - 0.35 * smoothstep(3.0, 1.0, lines)), meniscusLight(), 0.4 * smoothstep(1.3, 0.5, lines));
}

// The same below a heap of foam of this height, and in it, where `under_m` is negative: it carries air down.
vec3 withAir(vec3 water, float under_m, float heap_m) {
  vec2 at = vec2(v_world.x + v_world.z, v_world.y) / u_lace_m;
  float lumps = texture(u_noise, at / 0.4).r + 0.6 * texture(u_noise, at.yx / 0.13).r - 0.8;
  float sunk = (under_m + lumps * heap_m) / max(heap_m, 1e-4);
  vec3 foam = vec3(0.91, 0.95, 0.97) * (0.85 * u_ambient_up + (0.2 + 0.6 * max(dot(v_side_normal, u_sun_direction), 0.0)) * u_sun_light);
  foam = mix(foam, u_bubbly * u_water_light, 0.7 * smoothstep(-0.3, 3.0, sunk));
  return mix(water, foam, 0.95 * smoothstep(5.0, -0.6, sunk) * smoothstep(0.0, 0.02 * u_lace_m, heap_m));
}
