// Boats, rocks, walls and the bed: coloured triangles. FLOATS: a buoy, which rises and tilts with the water's surface. INSTANCES: objects in the
// water, drawn as instances of one mesh. VERTEX_LIT: the vertices are lit, for solid_plain.frag.
in vec3 position;
in vec3 normal;
in vec4 color;  // rgb, and the material's grain (0 paint, 1 stone, -1 lamp)
uniform mat4 modelMatrix;
uniform mat4 viewMatrix;
uniform mat4 projectionMatrix;
out vec3 v_world;
out vec3 v_normal;
out vec4 v_color;
#ifdef INSTANCES
#include <instance>
out vec3 v_own;         // position and normal along the object's own axes
out vec3 v_own_normal;
#endif
#ifdef FLOATS
uniform sampler2D u_field;
uniform vec2 u_extent_m;  // length and width of the water

const float kReachM = 0.25;  // of the water that moves it, from its middle

// Elevation and slopes of the water under the buoy.
vec3 waterAt(vec2 middle_m) {
  vec2 uv = middle_m / u_extent_m + 0.5;
  vec2 reach = kReachM / u_extent_m;
  vec3 sum = 2.0 * textureLod(u_field, uv, 0.0).rgb;
  sum += textureLod(u_field, uv + vec2(reach.x, 0.0), 0.0).rgb + textureLod(u_field, uv - vec2(reach.x, 0.0), 0.0).rgb;
  sum += textureLod(u_field, uv + vec2(0.0, reach.y), 0.0).rgb + textureLod(u_field, uv - vec2(0.0, reach.y), 0.0).rgb;
  return sum / 6.0;
}
#endif

#ifdef VERTEX_LIT
#include <solid_plain>
#endif

void main() {
  v_world = (modelMatrix * vec4(position, 1.0)).xyz;
  v_normal = mat3(modelMatrix) * normal;
#ifdef FLOATS
  vec3 water = waterAt(modelMatrix[3].xz);
  vec3 up = normalize(vec3(-water.y, 1.0, -water.z));
  vec3 side = normalize(vec3(up.y, -up.x, 0.0));
  mat3 tilt = mat3(side, up, cross(side, up));
  v_world = modelMatrix[3].xyz + vec3(0.0, water.x, 0.0) + tilt * position;
  v_normal = tilt * normal;
#endif
  v_color = color;
#ifdef INSTANCES
  v_world = placed(position);
  v_normal = turned(normal);
  v_color.rgb = painted(color.rgb);
  v_own = position + paint.rgb;
  v_own_normal = normal;
#endif
#ifdef VERTEX_LIT
#ifdef TANK
  bool is_over_water = any(greaterThan(abs(v_world.xz), 0.5 * u_extent_m));
#else
  const bool is_over_water = false;
#endif
  lightSolid(v_world, normalize(v_normal), v_color, is_over_water);
#endif
  gl_Position = projectionMatrix * viewMatrix * vec4(v_world, 1.0);
}
