// Binding of each resource. A resource has one number: its storage-buffer binding when a pass writes it, and its
// texture unit when a pass reads it through its texel view.
#ifndef SPINDRIFT_SHARED_BINDINGS_H
#define SPINDRIFT_SHARED_BINDINGS_H

// Uniform buffers.
#define SIM_UNIFORMS 0
#define EVENT_UNIFORMS 1
#define SEA_UNIFORMS 3
#define GAUGE_UNIFORMS 4
#define DISPERSION_UNIFORMS 5
#define MAKER_UNIFORMS 6

// Particles: position.xyz [m] + id, velocity.xyz [m/s] + foam [0..1].
#define POSITION 0
#define VELOCITY 1
// The same, ordered by cell, and by the previous order inside a cell.
#define SORTED_POSITION 2
#define SORTED_VELOCITY 3
// Values read by neighbours: position.xyz + pressure / density^2; velocity.xyz + mass / density.
#define PRESSURE_POINT 4
#define MOTION_POINT 5
// Acceleration.xyz [m/s^2] + density [kg/m^3].
#define ACCELERATION 6

// Grid: particles per cell; first particle of a cell (cell_count + 1 entries); per particle (cell, arrival in the cell);
// particle indices grouped by cell in arrival order; totals of the scan's runs of cells.
#define CELL_COUNT 7
#define CELL_START 8
#define CELL_ARRIVAL 9
#define CELL_MEMBER 10
#define RUN_TOTAL 11

// Wave, nx x nz cells: flow through the faces that a cell owns [m^2/s]; elevation now [units, fixed_point.h]; conductance
// of those faces [m]; loss rates in absorbing layers and on beaches [1/s] with the still depth of the cell [m]
// (sim_setup/basin.h); water that left through absorbing sides [units: low 24 bits, the rest].
#define FLOW 12
#define ELEVATION 13
#define BASIN 14
#define BED 19
#define OUTFLOW 20
// Water that a wave step moves through the faces that a cell owns [units]; the share of it that a cell can give [0..1];
// arguments of the indirect dispatches that compute and apply those shares. The numbers are those of the grid; only
// passes of the wave use these buffers.
#define TRANSFER 7
#define GIVEN_SHARE 8
#define LIMIT_ARGS 9
// Tiles that splashes reach. The number is that of the grid; only wave/splash.comp uses this buffer.
#define SPLASH_TILES 10
// Share of ELEVATION that moved through x faces, in matched layers [units] (binding shared with SURFACE_FLOW; no pass has
// both).
#define ELEVATION_X 16
// Dispersion, the grids of its V-cycle; dispersion/strip.glsl, dispersion/bottom.comp. The numbers are those of particles
// and grid; only its own passes use these buffers. What they compute for wave/momentum.comp is DISPERSED (binding shared with
// SURFACE; no pass has both): F grad(eta) at the faces that a cell owns [m * units per cell].
#define DISPERSION_FACES 0
#define DISPERSION_COARSE 2
#define DISPERSION_RIGHT 3
#define DISPERSION_COARSE_RIGHT 4
#define DISPERSION_COEFFICIENTS 5
#define DISPERSION_WEIGHTS 6
// Strips of a dispatch; the number is that of a table of the bottom, no pass has both.
#define DISPERSION_STRIPS 1
// Tables of the grids at the bottom.
#define DISPERSION_STIFFNESS 1
#define DISPERSION_SPREAD 7
#define DISPERSION_SWEEP 10
#define DISPERSION_FROM_X 11
#define DISPERSION_FROM_Z 18
#define DISPERSED 15
// The wind sea that comes in at absorbing sides; wave/incident_sea.comp. The numbers are those of particles and grid; only
// passes of the wave use these buffers.
#define SEA_BLOCKS 0
#define SEA_COLUMNS 1
#define SEA_ROWS 2
#define INCIDENT_SEA 10
// What crests across the whole domain do along their direction; wave/crest_profile.comp. As above.
#define CREST_PROFILE 0
// Nonlinear shallow water with dispersion: rise of the surface and of pressures across the faces that a cell owns [units]
// (binding shared with SURFACE_FLOW; no pass has both). There FLOW holds velocities [m/s] and flows [m^2/s].
#define SURFACE_RISE 16
// Elevation and the head of surface tension [units], in scenes with ripples: what the dispersion takes for ELEVATION. The number is
// that of the grid; only passes of the wave use this buffer.
#define TENSE_LEVEL 11
// Pressure on the surface (hulls, falling particles), as a height of water [units].
#define PRESSURE_HEAD 21
// Breaking: seconds since a cell began to break, intensity 0..1; and the same one substep ago.
#define BREAKING 22
#define BREAKING_BEFORE 23
// Surface for the particles: elevation, d eta/dt, d eta/dx, d eta/dz; horizontal flow of the wave [m/s].
#define SURFACE 15
#define SURFACE_FLOW 16

// Points that somebody asks for; diagnostics/points.comp. The number is that of the grid; only its own pass uses this buffer.
#define QUERY_POINTS 7

// Frames: packed words. Diagnostics: partial sums of work groups; readings of the gauges; values at points.
#define PACKED_WORDS 17
#define PARTIAL_SUM 18

// Ground for particles and boats, one texel per wave cell: signed distance to the nearest obstacle [m], its gradient
// (x, z), still depth [m]. The wet cell that receives water falling on a cell: the cell itself, or the nearest wet one.
#define TERRAIN 24
#define LANDING 25
// Pool of a two-way scene; shared/pool.h.
#define POOL 26
// Cells that emit a particle in this tick, in any order; the first POOL_WANTED count.
#define EMITTER 31
// Boats; shared/boats.h. Their controls are a uniform block.
#define BOATS 27
#define BOAT_CONTROLS 2
// Forces on hulls that another program moves; shared/boats.h. The number is that of the grid; only passes over boats use
// this buffer.
#define HULL_FORCES 8
// Floaters; shared/floaters.h. What contacts and particles change in a step; what each can touch in a tick; floaters in each tile;
// centre and reach of each [m]. The numbers are those of the grid; only passes over floaters, and those of particles after the grid, use
// these buffers. Push of floaters on boats; the number is that of particles, no pass has both.
#define FLOATERS 7
#define FLOATER_PUSH 8
#define FLOATER_NEAR 9
#define FLOATER_TILES 10
#define FLOATER_PLACES 11
#define BOAT_PUSH 5
// Foam on the surface, (n/2)^2 cells: share of white water by source (breaking, wakes, landings); the same one tick
// ago; number of particles that landed since the last tick.
#define FOAM_FIELD 28
#define FOAM_BEFORE 29
#define LANDED 30
// Water and momentum that particles brought back in this tick; coupling/landed_water.glsl (binding shared with OUTFLOW; no
// pass has both).
#define LANDED_WATER 20
// The simulation's uniforms as storage, for the pass that moves the particle patch (binding shared with PARTIAL_SUM; no
// pass has both).
#define SIM_UNIFORMS_STORAGE 18
// Particles with too many neighbour candidates, two words; grid/candidates.glsl (binding shared with EMITTER; no pass
// has both).
#define CROWDED 31
// How empty the sides of a particle are, in scenes with surface tension; particles/tension.glsl (binding shared with CELL_COUNT; no
// pass has both).
#define SURFACE_GRADIENT 7
// Candidates of a particle that are near: nine times (first candidate, bits) per particle; grid/candidates.glsl (binding shared with
// CELL_ARRIVAL; no pass has both).
#define NEAR_CANDIDATES 9
// Foam from few neighbours, one float per particle [0..1], in scenes that count neighbours (binding shared with
// PACKED_WORDS; no pass has both).
#define FOAM_SOURCE 17

#endif
