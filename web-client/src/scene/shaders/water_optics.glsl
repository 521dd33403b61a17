// Include: what light does in water and at its surface.
const vec3 kAbsorptionPerM = vec3(0.85, 0.19, 0.10);
const float kScatteringPerM = 0.55;

// Light that water scatters toward the eye, per its share along an infinite path. `lifted`: 0 in a trough, 1 in a crest.
vec3 waterScattered(float lifted) { return mix(vec3(0.004, 0.085, 0.155), vec3(0.030, 0.34, 0.40), lifted) * 1.2; }

// Schlick's fit of the Fresnel equations for water. `facing`: cosine between normal and ray.
float waterFresnel(float facing) {
  float away = (1.0 - facing) * (1.0 - facing);
  return 0.02 + 0.98 * away * away * (1.0 - facing);
}
