// A falling drop as a line, in a box that moves with the camera: what leaves it on one side comes in on the other.
in vec4 position;  // three random numbers of the drop; which end of the line

uniform mat4 viewMatrix;
uniform mat4 projectionMatrix;
uniform vec3 u_camera_m;
uniform vec3 u_velocity_mps;
uniform float u_time_s;

out float v_strength;

const vec3 kBoxM = vec3(18.0, 12.0, 18.0);
const float kExposureS = 0.028;

void main() {
  // Drops are not equally fast, or all would come back to their positions at the same time.
  vec3 velocity = u_velocity_mps * (0.85 + 0.3 * position.x);
  vec3 fallen = position.xyz * kBoxM + mod(velocity * u_time_s, kBoxM);
  vec3 from_camera = mod(fallen - u_camera_m, kBoxM) - 0.5 * kBoxM;
  float away_m = length(from_camera);
  v_strength = smoothstep(0.4, 1.5, away_m) * smoothstep(0.5 * kBoxM.y, 0.3 * kBoxM.y, abs(from_camera.y)) *
               (1.0 - smoothstep(0.3 * kBoxM.x, 0.5 * kBoxM.x, length(from_camera.xz)));
  vec3 at = u_camera_m + from_camera - position.w * kExposureS * velocity;
  // It ends at the still water: where the camera is half below the surface, there are no streaks in the water.
  v_strength *= step(0.0, at.y);
  gl_Position = projectionMatrix * (viewMatrix * vec4(at, 1.0));
}
