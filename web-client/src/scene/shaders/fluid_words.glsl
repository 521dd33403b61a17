// Include: a particle from the 12 bytes of the wire, read as six u16; the last three hold velocity x | velocity y, velocity z | density,
// foam | 0. Particles are drawn as points, not as instanced quads: software renderers handle each instance like a draw call (measured: 3
// times the processor time).
in vec3 position;  // x, z, y as fractions of the bounds
in vec3 a_packed;  // u16 / 65535

uniform vec3 u_min_m;
uniform vec3 u_max_m;
uniform float u_max_speed_mps;
uniform float u_advance_s;
uniform float u_radius_m;

float signedByte(uint bits) { return float(int(bits << 24u) >> 24) / 127.0; }

// At the time shown.
struct Particle {
  vec3 center_m;
  vec3 velocity_mps;
  float foam;     // 0..1
  float density;  // 0: half of that at rest, 1: 1.1 times
};

Particle unpackParticle() {
  uvec3 words = uvec3(a_packed * 65535.0 + 0.5);
  Particle particle;
  particle.velocity_mps = vec3(signedByte(words.x & 255u), signedByte(words.x >> 8u), signedByte(words.y & 255u)) * u_max_speed_mps;
  particle.center_m = mix(u_min_m, u_max_m, position.xzy) + particle.velocity_mps * u_advance_s;
  particle.foam = float(words.z & 255u) / 255.0;
  particle.density = float(words.y >> 8u) / 255.0;
  return particle;
}

// Four numbers in [0, 1) of one of the drops that stand for a particle: the same while it flies freely, by its level velocity.
vec4 randomOf(Particle particle, float drop) {
  vec2 level = round(127.0 * particle.velocity_mps.xz / max(u_max_speed_mps, 1e-3));
  // Particles that fly straight up have the same level velocity, but keep to their place.
  if (dot(level, level) < 7.0) level += 31.0 * floor(particle.center_m.xz / (2.0 * u_radius_m));
  vec3 at = vec3(level, drop);
  vec4 mixed = vec4(dot(at, vec3(127.1, 311.7, 74.7)), dot(at, vec3(269.5, 183.3, 246.1)), dot(at, vec3(113.5, 271.9, 124.6)), dot(at, vec3(419.2, 371.9, 95.3)));
  return fract(sin(mixed) * 43758.5453);
}
