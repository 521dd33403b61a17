// Include: what light does in water and at its surface.
const vec3 kAbsorptionPerM = vec3(0.85, 0.19, 0.10);
const float kScatteringPerM = 0.55;

// Light that water scatters toward the eye, per its share along an infinite path, at noon. `lifted`: 0 in a trough, 1 in a crest.
vec3 waterScattered(float lifted) { return mix(vec3(0.005, 0.102, 0.186), vec3(0.036, 0.408, 0.48), lifted); }

// Schlick's fit of the Fresnel equations for water. `facing`: cosine between normal and ray.
float waterFresnel(float facing) {
  float away = (1.0 - facing) * (1.0 - facing);
  return 0.02 + 0.98 * away * away * (1.0 - facing);
}
