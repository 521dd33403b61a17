// Include: what light does in water of the scene's type (light/water_optics.ts) and at its surface.
uniform vec3 u_loss_per_m;  // share of the light that is absorbed or scattered per metre
uniform vec3 u_scattered;   // light that deep water sends up at noon
uniform vec3 u_bubbly;      // the same of water full of bubbles
uniform vec3 u_crest;       // sunlight that a crest lets through, per metre of its height

// Light that water scatters toward the eye, per its share along an infinite path, at noon. `lifted`: 0 in a trough, 1 in a crest, into which
// light comes from all sides.
vec3 waterScattered(float lifted) { return u_scattered * mix(0.75, 1.9, lifted); }

// Schlick's fit of the Fresnel equations for water. `facing`: cosine between normal and ray.
float waterFresnel(float facing) {
  float away = (1.0 - facing) * (1.0 - facing);
  return 0.02 + 0.98 * away * away * (1.0 - facing);
}

// The normal of a slope as far as the eye sees it: slopes that turn away are hidden behind others. Where it faces the eye by less than `from`
// (as a cosine) it is turned toward it, and faces it by at least `least`. Cut off there, all of them would mirror the same, in patches with
// hard edges.
vec3 seenNormal(vec3 normal, vec3 ray, float from, float least) {
  float faces = -dot(normal, ray);
  if (faces > from) return normal;
  float slack = from - least;
  return normalize(normal + (faces - least - slack * exp((faces - from) / slack)) * ray);
}
