// Sun and sky light on painted or grainy solids. Wet stone and sand are darker. CAUSTICS: under water, waves focus the sunlight.
// TANK: where only what is inside the water's sides is under water.
// SHORE: the ground is wet where water was, mirrors the sky as long as a film stands on it, and carries the lace of the swash.
// FIELD: what stands upright in the water is wet and darker above the water's surface, and less of the sky lights it there.
// INSTANCES: the grain turns with the object. The plain tiers have solid_plain.frag. Distant land fades into the haze. Lamps (grain below 0) shine by themselves in the dark.
#include <sky>
#include <water_optics>

in vec3 v_world;
in vec3 v_normal;
in vec4 v_color;
#ifdef INSTANCES
in vec3 v_own;
in vec3 v_own_normal;
const float kGrainSizes = 1.6;  // size of one tile of the noise over the object's
#endif
uniform vec3 u_camera_m;
uniform sampler2D u_noise;
uniform vec2 u_extent_m;  // length and width of the water
uniform float u_grain_m;  // size of one tile of the noise
uniform float u_wet_m;    // height over the still water up to which stone is wet
uniform float u_haze_m;   // half of the light at this distance; 0: no haze
uniform float u_darkness; // 0 by day, 1 at night
#ifdef CAUSTICS
#include <caustics>
#endif
#ifdef SHADOWS
#include <shadow>
#endif
#ifdef SHORE
#include <shore>
// Wet over dry albedo, by eye. Light in wet sand is scattered more often before it leaves: water between the grains makes them scatter
// forward (Twomey, Bohren & Mergenthaler 1986), and the film reflects it back (Lekner & Dorf 1988). Blue, which sand absorbs most, loses most.
const vec3 kWetSand = vec3(0.58, 0.54, 0.50);
const vec3 kLace = vec3(0.80, 0.82, 0.82);
#endif
#ifdef FIELD
uniform sampler2D u_field;
// Heights over the water's surface up to which it wets what stands in it, and up to which the sky's light is less, m.
const float kWetBandM = 0.15, kDarkBandM = 0.3;
#endif
// Grain of what has leaves, the size of one tile of leaves over that of the noise, and the least brightness of a leaf on a sprig: one sees
// through the rest.
const float kLeavesGrain = 1.6, kLeavesTiles = 0.9, kSprigLeaf = 0.46;
// A mown lawn has more grain than this.
const float kLawnGrain = 1.05, kLeavesShadeM = 0.3;
const vec3 kScrub = vec3(0.17, 0.19, 0.08);
const float kSharper = -3.0;  // mip levels: hills are seen at a low angle
// Farthest that paint mirrors the waves beside it, m; slopes of their ripples, and the size of those, m.
const float kMirrorsM = 6.0, kMirroredSlope = 0.13, kMirroredM = 1.7;
layout(location = 0) out vec4 color;

void main() {
  vec3 normal = normalize(v_normal);
  vec3 albedo = v_color.rgb;
  float grain = max(v_color.a, 0.0);
  float wet_film = 0.0;
#ifdef TANK
  float over_water_m = any(greaterThan(abs(v_world.xz), 0.5 * u_extent_m)) ? 1e3 : v_world.y;
#else
  float over_water_m = v_world.y;
#endif
  if (grain > 0.0) {
#ifdef INSTANCES
    vec3 steep = abs(v_own_normal);
    // Wood has fibres along x.
    vec3 grain_at = v_own * vec3(grain < 0.8 ? 0.15 : 1.0, 1.0, 1.0);
    float grain_m = kGrainSizes;
#else
    // Sprigs are lit as their clump, not as they face (foliage.ts).
    vec3 facet = grain > kLeavesGrain ? normalize(cross(dFdx(v_world), dFdy(v_world))) : normal;
    vec3 steep = abs(facet);
    vec3 grain_at = v_world;
    float grain_m = u_grain_m;
#endif
    vec2 at = steep.y > max(steep.x, steep.z) ? grain_at.xz : steep.x > steep.z ? grain_at.zy : grain_at.xy;
    float fine = texture(u_noise, at / grain_m).r - 0.5;
    float coarse = texture(u_noise, at.yx / (5.3 * grain_m) + 0.37).r - 0.5;
    albedo *= 1.0 + grain * (0.34 * fine + 0.30 * coarse);
#ifndef INSTANCES
    if (grain > 0.95 && grain < kLawnGrain) {
      // Stone has spots of several sizes, and cracks.
      float spots = 0.5 * (texture(u_noise, at / (0.43 * grain_m)).r + texture(u_noise, at.yx / (0.13 * grain_m)).r);
      float crack = abs(texture(u_noise, at.yx / (1.7 * grain_m) + 0.11).r + 0.25 * (spots - 0.5) - 0.5);
      albedo *= (0.7 + 0.6 * spots) * mix(0.55, 1.0, smoothstep(0.0, 0.02, crack));
    }
    if (grain > kLeavesGrain) {
      // Leaves over the shade between them: the outline is torn where one looks along it.
      vec2 leaf_at = at / (kLeavesTiles * grain_m);
      float leaf = texture(u_noise, leaf_at).g;
      float bunch = texture(u_noise, leaf_at.yx / 4.7).g;
      vec3 toward = normalize(u_camera_m - v_world);
      bool is_sprig = abs(dot(facet, normal)) < 0.4;
      if (is_sprig ? leaf < kSprigLeaf : dot(normal, toward) < 0.75 * (0.85 - 0.5 * leaf - 0.65 * bunch)) discard;
      albedo *= (0.25 + 1.7 * leaf) * (0.45 + 1.25 * bunch);
    }
    if (u_haze_m > 0.0 && grain < kLawnGrain && normal.y > 0.7 && albedo.r > 1.05 * albedo.b) {
      // What grows on open land: scrub on dry sand, and woods and hedges on grass.
      float broad = texture(u_noise, at.yx / (31.0 * grain_m) + 0.71, kSharper).r;
      float middle = texture(u_noise, at / (9.0 * grain_m) + 0.19, kSharper).r;
      bool is_grass = albedo.g > albedo.r;
      if (is_grass) albedo *= mix(vec3(1.25, 1.12, 0.85), vec3(0.36, 0.46, 0.42), smoothstep(0.5, 0.75, 0.65 * broad + 0.35 * middle));
      else if (grain > 0.6 && grain < 0.75) {
        float tufts = texture(u_noise, at / (0.37 * grain_m) + 0.53).r;
        float scrub = smoothstep(0.5, 0.9, v_world.y) * smoothstep(0.36, 0.6, 0.35 * broad + 0.25 * middle + 0.4 * (0.95 - tufts));
        albedo = mix(albedo, kScrub, 0.7 * scrub);
      }
    }
#endif
    float wet = 1.0 - smoothstep(0.0, 1.0, over_water_m / u_wet_m - 0.5 * coarse);
    // Spray and the last waves have left a damp band above.
    wet = max(wet, 0.45 * (1.0 - smoothstep(1.5, 5.0, over_water_m / u_wet_m - 4.0 * coarse)));
#ifdef SHORE
    float inner = simulatedShore(v_world.xz, u_extent_m);
    // Sand has slopes on which it stays, and less grain than stone.
    bool is_sand = grain < 0.95 && normal.y > 0.8;
    float foam = 0.0;
    if (inner > 0.0) {
      vec3 shore = shoreAt(v_world.xz, u_extent_m);
      // With an edge that follows the sand's grain, not the cells.
      float washed = max(smoothstep(-0.004, 0.004, shore.r), smoothstep(0.0, 0.9, shore.g * (1.0 + 0.5 * fine + 0.6 * coarse)));
      wet_film = inner * washed * smoothstep(0.4, 1.0, shore.g) * (is_sand ? 0.7 : 0.35);
      // Under standing water, the water mirrors the sky and carries the lace, not the ground.
      float bare = 1.0 - smoothstep(0.004, 0.03, shore.r);
      wet_film *= bare;
      foam = inner * bare * shore.b;
      // Stone near the still water is always wet; sand is where water was.
      wet = is_sand ? mix(wet, washed, inner) : max(wet, inner * washed);
    }
    vec3 wet_albedo = vec3(1.0 - 0.42 * min(grain, 1.0));
    // The paint of the deep bed is that of ground which is never dry.
    if (is_sand) wet_albedo = mix(wet_albedo, kWetSand, clamp(1.0 + v_world.y / (10.0 * u_wet_m), 0.0, 1.0));
    albedo *= mix(vec3(1.0), wet_albedo, wet);
    if (foam > 0.02 && is_sand) {
      float lace = texture(u_noise, v_world.xz / (2.2 * u_grain_m)).r;
      float threads = smoothstep(1.0 - foam, 1.25 - 0.5 * foam, lace + 0.12) * smoothstep(0.02, 0.3, foam);
      albedo = mix(albedo, kLace, 0.8 * threads);
      wet_film *= 1.0 - threads;
    }
#else
    albedo *= 1.0 - 0.42 * min(grain, 1.0) * wet;
#endif
  }
  float seen_sky = 1.0;
  float wet_band = 0.0;
#ifdef FIELD
  // The surface a little outside the solid.
  vec2 beside = (v_world.xz + 0.2 * normal.xz) / u_extent_m + 0.5;
  float over_line_m = over_water_m - (all(lessThan(abs(beside - 0.5), vec2(0.5))) ? textureLod(u_field, beside, 0.0).r : 0.0);
  float upright = 1.0 - smoothstep(0.6, 0.85, normal.y);
  if (upright > 0.0 && over_line_m < kDarkBandM) {
    float ragged = texture(u_noise, vec2(v_world.x + v_world.z, 0.4 * v_world.y) / 0.9).r;
    upright *= smoothstep(-0.3, -0.02, over_line_m);
    // Water soaks into stone, with a ragged edge, and runs off paint.
    float soaks = min(2.0 * grain, 1.0);
    wet_band = upright * (1.0 - smoothstep(0.5, 1.0, over_line_m / (kWetBandM * mix(0.4, 0.45 + 1.1 * ragged, soaks))));
    seen_sky = 1.0 - 0.6 * upright * (1.0 - smoothstep(-0.02, kDarkBandM, over_line_m));
    // Paint darkens less than stone, and shines.
    albedo *= 1.0 - mix(0.4, 0.55, soaks) * wet_band;
  }
#endif
  float sun = max(dot(normal, u_sun_direction), 0.0);
  vec3 lit_at = v_world;
  vec3 lit_normal = normal;
  float soft_m = 0.0;
#ifdef CAUSTICS
  if (over_water_m < 0.0) {
    // Sunlight on this point crossed the surface further toward the sun and was refracted to a steeper path; some was reflected.
    vec3 level = refract(-u_sun_direction, vec3(0.0, 1.0, 0.0), 0.75);
    vec2 crossed = v_world.xz - level.xz / level.y * v_world.y;
    sun *= 0.96 * mix(1.0, focusedLight(crossed, -v_world.y), 0.85 * u_sun_sharp);
    lit_at = vec3(crossed.x, 0.0, crossed.y);
    lit_normal = vec3(0.0, 1.0, 0.0);
    // Waves scatter the light on its way down.
    soft_m = 0.12 * -v_world.y;
  }
#endif
#ifdef SHADOWS
  // Leaves let light through: on a lawn their shade has no edge.
  if (grain > kLawnGrain && normal.y > 0.99) soft_m = kLeavesShadeM;
  if (sun > 0.0) sun *= sunShare(lit_at, lit_normal, soft_m);
#endif
  vec3 ambient = mix(u_ambient_down, u_ambient_up, normal.y * 0.5 + 0.5);
  // Lamps are painted brighter than white.
  vec3 lit = albedo * (u_sun_light * 1.25 * sun + ambient) * seen_sky + 1.5 * max(v_color.rgb - 1.0, 0.0);
  vec3 ray = v_world - u_camera_m;
  float distance_m = length(ray);
  ray /= distance_m;
#ifdef SHORE
  if (wet_film > 0.01) {
    // A film over grains: its mirror is as level as water, and broken by the grains.
    vec3 level = normalize(mix(normal, vec3(0.0, 1.0, 0.0), 0.5));
    float past = 1.0 - clamp(-dot(level, ray), 0.0, 1.0);
    float mirror = wet_film * (0.02 + 0.75 * past * past * past * past * past);
    vec3 over = reflect(ray, level);
    over.y = abs(over.y);
    lit = mix(lit, skyLight(over), mirror) + wet_film * u_sun_sharp * u_sun_light * 0.35 * pow(max(dot(over, u_sun_direction), 0.0), 60.0);
  }
#endif
  float away = 1.0 - clamp(-dot(normal, ray), 0.0, 1.0);
  // Paint is varnished: Fresnel's equations by eye, for varnish that is not even.
  float shine = (0.09 + 0.80 * away * away * away * away) * (1.0 - min(grain, 1.0) * (1.0 - wet_band)) * (1.0 + wet_band) * seen_sky;
  if (shine > 0.01 && over_water_m > 0.0) {
    vec3 mirrored = reflect(ray, normal);
    float mirrors = 1.0;
    vec3 water = vec3(0.0);
    if (mirrored.y < 0.0) {
      // The waves beside it, which mirror the sky in turn.
      vec2 wave_at = v_world.xz + mirrored.xz * min(over_water_m / -mirrored.y, kMirrorsM);
      vec2 slopes = kMirroredSlope * (vec2(texture(u_noise, wave_at / kMirroredM).r, texture(u_noise, wave_at.yx / (1.3 * kMirroredM)).r) - 0.5);
#ifdef FIELD
      slopes += textureLod(u_field, wave_at / u_extent_m + 0.5, 0.0).gb;
#endif
      vec3 up = normalize(vec3(-slopes.x, 1.0, -slopes.y));
      mirrors = waterFresnel(clamp(-dot(up, mirrored), 0.0, 1.0));
      water = waterScattered(0.4) * u_water_light;
      mirrored = reflect(mirrored, up);
    }
    mirrored.y = abs(mirrored.y);
    lit += shine * mix(water, skyLight(mirrored), mirrors) + (1.0 - grain) * mirrors * u_sun_light * 0.5 * pow(max(dot(mirrored, u_sun_direction), 0.0), 80.0);
  }
  if (u_haze_m > 0.0) {
    float hazy = max(distance_m - 2.0 * max(u_extent_m.x, u_extent_m.y), 0.0) / u_haze_m;
    if (hazy > 0.01) lit = mix(lit, skyLight(vec3(ray.x, max(ray.y, 0.01), ray.z)), 0.9 * hazy / (1.0 + hazy));
  }
  if (v_color.a < 0.0) lit = mix(lit, 5.0 * v_color.rgb, u_darkness);
  color = vec4(lit, 1.0);
}
