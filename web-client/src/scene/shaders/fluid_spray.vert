// Drops of particles over a wave: those that fly apart from the liquid (VOLUME), or all. A particle stands for many drops and is drawn as a
// few of them, one per draw (u_drop), along its flight. They keep their places while it flies freely (fluid_words.glsl). The first is the
// puff of fine drops among them.
#include <fluid_words>
#ifdef VOLUME
#include <fluid_volume>
#endif
#define EXPOSURE_S 0.008
#define MOST_SHARE 0.0014
#include <drop>

uniform float u_drop;
uniform sampler2D u_field;
uniform vec2 u_extent_m;  // length and width of the water

#ifdef VOLUME
// Density of the volume at a particle between which it comes away from the liquid.
const float kAlone = 0.30, kAmongOthers = 0.55, kAmongWhite = 0.9;
#endif
// Sunlight that a density takes up.
const float kShade = 6.0;
// Particles larger than this are drawn like those of this radius, m.
const float kLargeM = 0.07;
// Radius of a puff in particle radii, how far it has come apart, and how much it hides.
const float kPuffWidth = 2.2, kTorn = 0.4, kPuffStrength = 0.7;
// How far drops lie from the path of their particle, fine and large ones, in particle radii; and the time of its flight that they span.
const float kFineRadii = 1.1, kLargeRadii = 0.9, kTrailS = 0.14;

void main() {
  Particle particle = unpackParticle();
  noDrop();
#ifdef VOLUME
  float density = volumeAt(particle.center_m).r;
  // Single ones hide less than a cloud of them.
  float strength = (1.0 - smoothstep(kAlone, mix(kAmongOthers, kAmongWhite, particle.foam), density)) * mix(0.2, 1.0, smoothstep(0.05, 0.3, density));
  if (strength <= 0.0) return;
#else
  float strength = 1.0;
#endif
  vec4 random = randomOf(particle, u_drop);
  float radius_m = min(u_radius_m, kLargeM);
  // Few are large.
  float large = pow(random.w, 10.0);
  bool is_puff = u_drop == 0.0;
  vec3 center_m = particle.center_m;
  if (!is_puff) center_m += u_radius_m * mix(kFineRadii, kLargeRadii, random.w) * (random.xyz - 0.5) + particle.velocity_mps * (kTrailS * (random.w - 0.5));
  if (center_m.y < texture(u_field, center_m.xz / u_extent_m + 0.5).r) return;
#ifdef VOLUME
  float sunlit = exp(-kShade * volumeAt(center_m + 4.0 * u_radius_m * u_sun_direction).r);
#else
  const float sunlit = 0.6;
#endif
  if (is_puff) drawPuff(center_m, particle.velocity_mps, kPuffWidth * radius_m, vec3(random.xy, kTorn), kPuffStrength * strength * particle.foam, sunlit);
  else drawDrop(center_m, particle.velocity_mps, radius_m * mix(0.028, 0.32, large), strength * (0.35 + 0.65 * particle.foam) * mix(0.6, 1.15, random.x), sunlit);
}
