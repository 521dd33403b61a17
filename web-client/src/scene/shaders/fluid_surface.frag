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
#ifdef WAVE
uniform sampler2D u_field;
uniform vec2 u_extent_m;  // length and width of the water
#endif
const float kLeastFacing = 0.18;
// Size of one tile of the noise in particle radii.
const float kLaceRadii = 26.0;
const float kOutlineBend = 0.8;
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
  // A soft edge where the fluid meets a solid.
  float covered = smoothstep(kCoveredFrom, kCoveredTo, through.a) * smoothstep(-0.1, 0.5, (solid_m - ahead_m) / u_radius_m);
  if (covered <= 0.0) discard;

  vec3 view_ray = vec3((v_uv * 2.0 - 1.0) * u_ray.xy + u_ray.zw, -1.0);
  vec3 world = u_camera_m + mat3(u_camera_world) * (view_ray * ahead_m);
  vec3 ray = normalize(world - u_camera_m);
  // Neighbours over which the particles' own pattern averages out. The coverage falls toward the outline, where the surface turns away.
  vec2 apart = 1.5 * u_radius_m * front * 0.5 / u_ray.xy;
  vec4 right = texture(u_thickness, v_uv + vec2(apart.x, 0.0)), left = texture(u_thickness, v_uv - vec2(apart.x, 0.0));
  vec4 upper = texture(u_thickness, v_uv + vec2(0.0, apart.y)), lower = texture(u_thickness, v_uv - vec2(0.0, apart.y));
  through.r = 0.2 * (through.r + right.r + left.r + upper.r + lower.r);
  vec2 outward = vec2(left.a - right.a, lower.a - upper.a);
  vec3 normal = mat3(u_camera_world) * normalize(normalize(normal_foam.xyz) + vec3(kOutlineBend * outward, 0.0));
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
  float alone = 1.0 - clamp(through.b / max(through.g, 1e-4), 0.0, 1.0);
  // Foam is white where the noise is above a threshold that falls with the foam, so that a thin sheet stays clear between its threads.
  // Seen along the axis that the surface faces most, so that it is stretched nowhere.
  vec3 axes = normal * normal * normal * normal;
  vec3 at = world / (kLaceRadii * u_radius_m);
  float lace = dot(axes, vec3(texture(u_noise, at.zy).r, texture(u_noise, at.xz).r, texture(u_noise, at.xy).r)) / (axes.x + axes.y + axes.z);
  float strength = 0.6 * smoothstep(0.4, 1.0, foam);
  float threads = smoothstep(1.0 - strength, 1.7 - 0.7 * strength, lace + 0.1);
  float white = mix(threads * (0.4 + 0.4 * foam), 0.3 * foam, alone * raised);
  // Near an outline the far side reflects totally, so that the path is longer than the ray's straight way out.
  float folded_m = 6.0 * u_radius_m * (1.0 - exp(-thickness_m / u_radius_m)) * (1.0 - alone) * raised;
  float path_m = (thickness_m + folded_m) * u_colour_ratio;
  vec3 passed = exp(-u_loss_per_m * path_m);
  float sun = clamp(dot(normal, u_sun_direction) * 0.5 + 0.5, 0.0, 1.0);
  float against_sun = max(dot(ray, u_sun_direction), 0.0);
  vec3 scattered = waterScattered(0.25 + 0.4 * clamp(normal.y, 0.0, 1.0)) * u_water_light * (0.5 + 0.6 * sun);
  scattered += u_crest * u_sun_light * against_sun * against_sun * 0.35;
  vec3 glow = scattered * (1.0 - passed);

  float facing = clamp(-dot(normal, ray), 0.0, 1.0);
  float fresnel = waterFresnel(facing) * raised;
  vec3 mirrored = reflect(ray, normal);
  vec3 mirrored_light = skyLight(vec3(mirrored.x, abs(mirrored.y), mirrored.z));
  float at_sun = dot(mirrored, u_sun_direction);
  vec3 glint = vec3(0.0);
  if (at_sun > 0.9) glint = raised * u_sun_sharp * u_sun_light * (pow(at_sun, 700.0) * 9.0 + pow(at_sun, 70.0) * 0.5) * (0.1 + fresnel);

  vec3 froth = vec3(0.93, 0.96, 0.97) * (u_sun_light * 1.05 * sun * sun + u_ambient_up * vec3(1.05, 0.98, 0.91));
  vec3 bent = refract(ray, normal, 0.75);
  vec3 lens = skyLight(normalize(bent + 0.6 * (bent - ray))) * (0.55 + 0.4 * sun);
#ifdef WAVE
  // The picture behind shows through by the green share that passes.
  float kept = (1.0 - fresnel) * passed.g * (1.0 - white) * (1.0 - 0.4 * alone * raised);
  vec3 own = mix(fresnel * mirrored_light + glint + (1.0 - fresnel) * mix(glow, lens * 0.6, alone * raised), froth, white);
  color = vec4(toDisplay(own / max(1.0 - kept, 0.02)), covered * (1.0 - kept));
#else
  // The point where the refracted ray leaves the fluid, and what the screen shows there.
  vec3 leaves = transpose(mat3(u_camera_world)) * (world + bent * min(thickness_m, 0.8 * (solid_m - ahead_m) + u_radius_m) - u_camera_m);
  vec2 uv = clamp(((leaves.xy / -leaves.z - u_ray.zw) / u_ray.xy) * 0.5 + 0.5, 0.001, 0.999);
  if (distanceAt(uv) < ahead_m) uv = v_uv;
  vec3 behind = texture(u_behind, uv).rgb;
  // Below the horizon the floor is reflected, of which the screen shows a part.
  mirrored_light = mix(mirrored_light, behind, smoothstep(0.1, -0.1, mirrored.y));
  vec3 inside = mix(behind * passed + glow, lens, 0.4 * alone);
  color = vec4(toDisplay(mix(mix(inside, mirrored_light, fresnel) + glint, froth, white)), covered);
#endif
}
