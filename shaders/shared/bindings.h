// Where each resource is bound. A resource has one number: its storage-buffer binding when a pass writes it, and its
// texture unit when a pass reads it through its texel view.
#ifndef SPINDRIFT_SHARED_BINDINGS_H
#define SPINDRIFT_SHARED_BINDINGS_H

// Uniform buffers.
#define SIM_UNIFORMS 0
#define EVENT_UNIFORMS 1

// Particles: position.xyz [m] + id, velocity.xyz [m/s] + foam [0..1].
#define POSITION 0
#define VELOCITY 1
// The same, ordered by cell, and by the previous order inside a cell.
#define SORTED_POSITION 2
#define SORTED_VELOCITY 3
// What a neighbour needs to know: position.xyz + pressure / density^2; velocity.xyz + mass / density.
#define PRESSURE_POINT 4
#define MOTION_POINT 5
// Acceleration.xyz [m/s^2] + density [kg/m^3].
#define ACCELERATION 6

// Grid: particles per cell; first particle of a cell (cell_count + 1 entries); per particle (cell, arrival in the cell);
// particle indices grouped by cell in arrival order; totals of the scan's blocks.
#define CELL_COUNT 7
#define CELL_START 8
#define CELL_ARRIVAL 9
#define CELL_MEMBER 10
#define BLOCK_TOTAL 11

// Wave levels: elevation [m] at t - dt, t, t + dt.
#define ELEVATION_PREVIOUS 12
#define ELEVATION 13
#define ELEVATION_NEXT 14
// Surface as the particles see it: elevation, d eta/dt, d eta/dx, d eta/dz; horizontal flow of the wave [m/s].
#define SURFACE 15
#define SURFACE_FLOW 16

// Frames: packed words. Diagnostics: partial sums of work groups.
#define PACKED_WORDS 17
#define PARTIAL_SUM 18

// Foam from few neighbours, one float a particle [0..1]. Scenes that count neighbours only.
#define FOAM_SOURCE 26

#endif
