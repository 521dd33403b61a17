// The particle pool of a two-way scene. Only the device knows the number of particles, so counts and the sizes of
// indirect dispatches are in one small buffer of words.
#ifndef SPINDRIFT_SHARED_POOL_H
#define SPINDRIFT_SHARED_POOL_H

// Particles in POSITION before the grid is built: those of the last substep, including dead ones, and new ones.
#define POOL_COUNT 0
// Particles in the sorted arrays, all alive; after integration, in POSITION, some may be dead.
#define POOL_LIVE 1
// Particles that breaking cells want to emit in this substep; coupling/plan.comp sets it to 0 if there is no room for
// all of them.
#define POOL_WANTED 2
// Next free slot while coupling/emit.comp runs.
#define POOL_NEXT 3
// Since the start: particles emitted, particles absorbed, substeps in which the pool had no room.
#define POOL_EMITTED 4
#define POOL_ABSORBED 5
#define POOL_REFUSED 6
// Cells in EMITTER that emit now.
#define POOL_EMITTING 7
// Arguments of indirect dispatches (three words each): over emitting cells, over particles, over grid cells, over scan
// blocks, one group. All 0 while there is nothing to do. No pass uses those over grid cells; they are written because hashes of
// states cover them.
#define POOL_EMIT_ARGS 8
#define POOL_PARTICLE_ARGS 11
#define POOL_CELL_ARGS 14
#define POOL_BLOCK_ARGS 17
#define POOL_ONE_ARGS 20
#define POOL_WORDS 24

// position.w of an absorbed particle; the next sort drops it.
#define DEAD_ID -1.0f

// Words of LANDED_WATER per wave cell: water [units], its momentum along x and z (height times velocity, 2^-16 m^2/s).
#define LANDED_WORDS 3
#define MOMENTUM_UNITS 65536.0f

#endif
