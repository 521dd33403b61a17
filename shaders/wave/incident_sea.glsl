// The sea that comes in from outside (wave/incident_sea.comp). In the layer of an absorbing side the loss acts on what differs
// from it: that sea passes the layer unchanged, and everything else is absorbed.
#ifndef SPINDRIFT_INCIDENT_SEA
#define SPINDRIFT_INCIDENT_SEA

layout(binding = INCIDENT_SEA) uniform samplerBuffer incident_sea;

/// Elevation that the layer keeps up at a cell: the parts of water that moves along x and along z, whose sum counts in a
/// sponge. [units]
vec2 incidentElevation(int i) { return texelFetch(incident_sea, i).xw; }

/// Flow that the layer keeps up at the faces toward +x and +z. [m^2/s]
vec2 incidentFlow(int i) { return texelFetch(incident_sea, i).yz; }

#endif
