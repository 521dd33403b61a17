// Objects drawn as instances of one mesh of size 1 about its middle.
in vec4 place;  // middle and size [m]
in vec4 turn;   // rotation: unit quaternion x, y, z, w
in vec4 paint;  // of the object itself, and its shade

vec3 turned(vec3 own) {
  return own + 2.0 * cross(turn.xyz, cross(turn.xyz, own) + turn.w * own);
}

vec3 placed(vec3 own) {
  return place.xyz + place.w * turned(own);
}

// A red below 0 stands for the object's own paint times a share.
vec3 painted(vec3 vertex_color) {
  return paint.w * (vertex_color.r < 0.0 ? -vertex_color.r * paint.rgb : vertex_color);
}
