// Include: the shore of water that moves over its ground, from shore/shore_pass.ts.
uniform sampler2D u_shore;

// Depth over the bed (m; below 0: dry), wetness of the ground, foam.
vec3 shoreAt(vec2 at, vec2 extent_m) { return textureLod(u_shore, at / extent_m + 0.5, 0.0).rgb; }
