// Light from the fluid to the eye: reflected sky by Fresnel, and through the fluid the scene behind, refracted, absorbed along the
// thickness and replaced by scattered light, as in water.frag. Foam covers it.
// Reads u_front (1 / distance [1/m]), u_normals (view space; foam), u_thickness (thickness [m], weight, weight of
// particles among others, coverage), the solids' colour and depth. Blends over the picture; writes the fluid's depth.
// WAVE: the fluid is one body with the wave, which lies in the picture and its depth buffer already. Toward the surface, normal and
// light become those of the wave. Without it the fluid shows the solids refracted.
#include <sky>
#include <water_optics>
#include <fluid_sizes>

in vec2 v_uv;
uniform sampler2D u_front;
uniform sampler2D u_normals;
uniform sampler2D u_thickness;
uniform sampler2D u_behind;
uniform sampler2D u_behind_depth;
uniform vec4 u_ray;        // view ray (x, y, -1) = ndc * u_ray.xy + u_ray.zw
uniform vec2 u_near_far_m;
uniform mat4 u_projection;
uniform mat4 u_camera_world;
uniform vec3 u_camera_m;
uniform float u_radius_m;
uniform sampler2D u_noise;
uniform float u_colour_ratio;  // lengths in the fluid count as so much longer for its colour
uniform vec2 u_extent_m;  // length and width of the water
#ifdef WAVE
uniform sampler2D u_field;
#else
uniform float u_floor_m;
const float kTankGlow = 1.8;  // a pale floor and walls light the water from all sides

// Where a ray from the camera enters the tank and leaves it, in lengths of `ray`. `pane`: normal of the side by which it enters.
vec2 throughTank(vec3 ray, out vec3 pane) {
  vec3 safe = mix(vec3(1e-6), ray, step(vec3(1e-6), abs(ray)));
  vec3 a = (vec3(-0.5 * u_extent_m.x, u_floor_m, -0.5 * u_extent_m.y) - u_camera_m) / safe;
  vec3 b = (vec3(0.5 * u_extent_m.x, 1e3, 0.5 * u_extent_m.y) - u_camera_m) / safe;
  vec3 near = min(a, b), far = max(a, b);
  pane = near.x > near.z ? vec3(-sign(ray.x), 0.0, 0.0) : vec3(0.0, 0.0, -sign(ray.z));
  return vec2(max(max(near.x, near.z), 0.0), min(min(far.x, far.z), far.y));
}
#endif
const float kLeastFacing = 0.18;
// Size of one tile of the noise in particle radii.
const float kLaceRadii = 17.0;
const float kOutlineBend = 0.45;
layout(location = 0) out vec4 color;

// 1 / distance between texels of the smaller target, without those that are empty.
float frontAt(vec2 uv) {
  vec2 at = uv * vec2(textureSize(u_front, 0)) - 0.5;
  ivec2 low = ivec2(floor(at));
  vec2 f = at - vec2(low);
  ivec2 last = textureSize(u_front, 0) - 1;
  vec4 w = vec4((1.0 - f.x) * (1.0 - f.y), f.x * (1.0 - f.y), (1.0 - f.x) * f.y, f.x * f.y);
  vec4 texels = vec4(texelFetch(u_front, clamp(low, ivec2(0), last), 0).r, texelFetch(u_front, clamp(low + ivec2(1, 0), ivec2(0), last), 0).r,
                     texelFetch(u_front, clamp(low + ivec2(0, 1), ivec2(0), last), 0).r, texelFetch(u_front, clamp(low + 1, ivec2(0), last), 0).r);
  w *= step(1e-9, texels);
  return dot(w, texels) / max(w.x + w.y + w.z + w.w, 1e-6);
}

float distanceAt(vec2 uv) {
  float near = u_near_far_m.x, far = u_near_far_m.y;
  return near * far / (far - (far - near) * texture(u_behind_depth, uv).r);
}

void main() {
  vec4 through = texture(u_thickness, v_uv);
  if (through.a < 0.02) discard;
  float front = frontAt(v_uv);
  vec4 normal_foam = texture(u_normals, v_uv);
  if (front <= 0.0 || dot(normal_foam.xyz, normal_foam.xyz) < 1e-6) discard;
  float ahead_m = 1.0 / front;
  float solid_m = distanceAt(v_uv);
  float single = smoothstep(0.25, 0.9, 1.0 - through.b / max(through.g, 1e-4));
  // Bulk water has an outline, a single drop a soft alpha. A soft edge where the fluid meets a solid.
  float covered = mix(smoothstep(kCoveredFrom, kCoveredTo, through.a), 0.9 * through.a, single) * smoothstep(-0.1, 0.5, (solid_m - ahead_m) / u_radius_m);
  vec3 view_ray = vec3((v_uv * 2.0 - 1.0) * u_ray.xy + u_ray.zw, -1.0);
#ifdef WAVE
  const float at_pane = 0.0;
#else
  // Water lies flat against the glass and ends there, although its particles bulge.
  vec3 pane;
  vec3 axis_ray = mat3(u_camera_world) * view_ray;
  vec2 tank = throughTank(axis_ray, pane);
  float inside_m = tank.y - tank.x;
  float off_pane = (ahead_m - tank.x) * abs(dot(axis_ray, pane)) / u_radius_m;
  float near_pane = 1.0 - smoothstep(1.5, 3.0, off_pane);
  covered = max(covered, near_pane * smoothstep(0.12, 0.3, through.a));
  covered *= clamp(0.5 + inside_m / max(fwidth(inside_m), 1e-6), 0.0, 1.0);
  // Behind the pane's inner face.
  ahead_m = max(ahead_m, tank.x + 0.1 * u_radius_m);
  front = 1.0 / ahead_m;
#endif
  if (covered <= 0.0) discard;

  vec3 world = u_camera_m + mat3(u_camera_world) * (view_ray * ahead_m);
  vec3 ray = normalize(world - u_camera_m);
  // Neighbours over which the particles' own pattern averages out. The coverage falls toward the outline, where the surface turns away.
  vec2 apart = 1.5 * u_radius_m * front * 0.5 / u_ray.xy;
  vec4 right = texture(u_thickness, v_uv + vec2(apart.x, 0.0)), left = texture(u_thickness, v_uv - vec2(apart.x, 0.0));
  vec4 upper = texture(u_thickness, v_uv + vec2(0.0, apart.y)), lower = texture(u_thickness, v_uv - vec2(0.0, apart.y));
  through.r = 0.2 * (through.r + right.r + left.r + upper.r + lower.r);
  vec2 outward = vec2(left.a - right.a, lower.a - upper.a);
  vec3 normal = mat3(u_camera_world) * normalize(normalize(normal_foam.xyz) + vec3(kOutlineBend * outward, 0.0));
#ifndef WAVE
  // The edge between the flat side and the surface is sharp, although that of the particles is round.
  float toward_pane = dot(normal, pane);
  float at_pane = near_pane * smoothstep(0.25, 0.75, toward_pane);
  normal -= pane * max(toward_pane, 0.0) * (1.0 - smoothstep(2.0, 5.0, off_pane));
  normal = normalize(mix(normal, pane, at_pane) + vec3(0.0, 1e-4, 0.0));
  ahead_m = mix(ahead_m, tank.x, at_pane);
  world = u_camera_m + axis_ray * ahead_m;
#endif
  float foam = clamp(normal_foam.a / max(length(normal_foam.xyz), 1e-3), 0.0, 1.0);
  float thickness_m = min(through.r, max(solid_m - ahead_m, 0.0) * length(view_ray));
  gl_FragDepth = clamp(0.5 * (u_projection[3][2] * front - u_projection[2][2]) + 0.5, 0.0, 1.0);

  float raised = 1.0;
#ifdef WAVE
  vec4 field = texture(u_field, world.xz / u_extent_m + 0.5);
  raised = smoothstep(0.0, 1.5, (world.y - field.r) / u_radius_m);
  normal = normalize(mix(vec3(-field.g, 1.0, -field.b), normal, raised));
  // Drawn in front of the wave's surface, from which it can hardly be told.
  gl_FragDepth -= 1e-4 * (1.0 - raised);
#endif
  // At the lowest angles a normal from few pixels says little, and the reflection would hide the fluid.
  if (dot(normal, ray) > -kLeastFacing) normal = normalize(normal - (dot(normal, ray) + kLeastFacing) * ray);

  // A single drop is a lens: it shows the sky. Foam makes it cloudy; among other particles it is a closed white layer.
  float alone = (1.0 - at_pane) * single;
  // Foam is white where the noise is above a threshold that falls with the foam, so that a thin sheet stays clear between its threads.
  // Seen along the axis that the surface faces most, so that it is stretched nowhere.
  vec3 axes = normal * normal * normal * normal;
  vec3 at = world / (kLaceRadii * u_radius_m);
  vec3 fine = at * 2.7 + 0.31;
  vec3 laces = 0.55 * vec3(texture(u_noise, at.zy, 2.0).r, texture(u_noise, at.xz, 2.0).r, texture(u_noise, at.xy, 2.0).r) +
               0.45 * vec3(texture(u_noise, fine.zy).r, texture(u_noise, fine.xz).r, texture(u_noise, fine.xy).r);
  float lace = dot(axes, laces) / (axes.x + axes.y + axes.z);
  float strength = 0.85 * smoothstep(0.3, 1.0, foam);
  float threads = smoothstep(0.85 - 0.85 * strength, 1.35 - 0.55 * strength, lace);
  // A drop glitters on all sides, and is never darker than what it hides.
  float white = mix(mix(threads, 1.0, 0.5 * strength) * (0.5 + 0.4 * foam), 0.35 + 0.25 * foam, alone * raised);
  // Near an outline the far side reflects totally, so that the path is longer than the ray's straight way out.
  float folded_m = 3.0 * u_radius_m * (1.0 - exp(-thickness_m / u_radius_m)) * (1.0 - alone) * (1.0 - at_pane) * raised;
  float path_m = (thickness_m + folded_m) * u_colour_ratio;
  vec3 passed = exp(-u_loss_per_m * path_m);
  float sun = clamp(dot(normal, u_sun_direction) * 0.5 + 0.5, 0.0, 1.0);
  float against_sun = max(dot(ray, u_sun_direction), 0.0);
  vec3 scattered = waterScattered(0.25 + 0.4 * clamp(normal.y, 0.0, 1.0)) * u_water_light * (0.5 + 0.6 * sun);
#ifndef WAVE
  scattered *= kTankGlow;
#endif
  scattered += u_crest * u_sun_light * against_sun * against_sun * 0.35;
  vec3 glow = scattered * (1.0 - passed);

  float facing = clamp(-dot(normal, ray), 0.0, 1.0);
  // Glass hides most of the reflection of the water behind it.
  float fresnel = waterFresnel(facing) * raised * (1.0 - 0.85 * at_pane);
  vec3 mirrored = reflect(ray, normal);
  // The particles' surface is not smooth enough for a sharp mirror.
  vec3 mirrored_light = textureLod(u_sky, vec3(mirrored.x, abs(mirrored.y), mirrored.z), 4.0).rgb;
  float at_sun = dot(mirrored, u_sun_direction);
  vec3 glint = vec3(0.0);
  if (at_sun > 0.9) glint = raised * u_sun_sharp * u_sun_light * (pow(at_sun, 700.0) * 9.0 + pow(at_sun, 70.0) * 0.5) * (0.1 + fresnel) * (1.0 - at_pane);

  vec3 froth = vec3(0.93, 0.96, 0.97) * (u_sun_light * 1.05 * sun * sun + u_ambient_up * vec3(1.05, 0.98, 0.91));
  vec3 bent = refract(ray, normal, 0.75);
  vec3 lens = skyLight(normalize(bent + 0.6 * (bent - ray))) * (0.55 + 0.4 * sun);
#ifdef WAVE
  // The picture behind shows through by the green share that passes.
  float kept = (1.0 - fresnel) * passed.g * (1.0 - white) * (1.0 - 0.4 * alone * raised);
  vec3 own = mix(fresnel * mirrored_light + glint + (1.0 - fresnel) * mix(glow, lens * 0.8, alone * raised), froth, white);
  color = vec4(toDisplay(own / max(1.0 - kept, 0.02)), covered * (1.0 - kept));
#else
  // The point where the refracted ray leaves the fluid, and what the screen shows there.
  float reach_m = min(thickness_m, 0.8 * (solid_m - ahead_m) + u_radius_m);
  // Behind a pane up to the floor or the far pane. Sides that it meets at a low angle reflect it totally.
  vec3 half_m = vec3(0.5 * u_extent_m.x, 0.0, 0.5 * u_extent_m.y);
  vec3 ways_m = (vec3(sign(bent.x) * half_m.x, u_floor_m, sign(bent.z) * half_m.z) - world) / (mix(vec3(1e-5), bent, step(vec3(1e-5), abs(bent))));
  bvec2 is_total = lessThan(abs(bent.xz), vec2(0.66));
  float floor_m = bent.y < 0.0 ? max(ways_m.y, 0.0) : 1e3;
  float out_m = min(floor_m, min(is_total.x ? 1e3 : ways_m.x, is_total.y ? 1e3 : ways_m.z));
  vec3 leaves = world + bent * min(mix(reach_m, min(out_m, 4.0 * half_m.x), at_pane), floor_m);
  vec2 folded = 2.0 * clamp(leaves.xz, -half_m.xz, half_m.xz) - leaves.xz;
  leaves.xz = mix(leaves.xz, folded, is_total);
  leaves = transpose(mat3(u_camera_world)) * (leaves - u_camera_m);
  vec2 uv = ((leaves.xy / -leaves.z - u_ray.zw) / u_ray.xy) * 0.5 + 0.5;
  if (any(greaterThan(abs(uv - 0.5), vec2(0.499))) || distanceAt(uv) < ahead_m - u_radius_m) uv = v_uv;
  vec3 behind = texture(u_behind, uv).rgb;
  // Below the horizon the floor is reflected, of which the screen shows a part.
  mirrored_light = mix(mirrored_light, behind, smoothstep(0.1, -0.1, mirrored.y));
  vec3 inside = mix(behind * passed + glow, max(lens, behind), 0.8 * alone);
  color = vec4(toDisplay(mix(mix(inside, mirrored_light, fresnel) + glint, froth, white)), covered);
#endif
}
